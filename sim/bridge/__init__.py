"""The simulator as a ROS 2 robot: `/scan`, `/odom` and `/clock` out, `/cmd_vel` in.

`sim.bridge.messages` holds the pure conversions. Nothing here is imported by `import sim`.
"""
