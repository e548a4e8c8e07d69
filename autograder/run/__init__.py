"""Runs students' programs: sandboxes, the fork server, and ROS time in lockstep."""
