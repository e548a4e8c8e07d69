"""The hidden suite of 04_launch: launch files for one robot, for two, and for a start that waits for a self-test."""

PACKAGES = ("my_robot_bringup",)
READS = ("solutions/my_robot_bringup",)  # contains the given programs, which the launches start
MODULES = ("robot", "fleet", "safe_start")
