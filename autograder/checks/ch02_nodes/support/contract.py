"""The numbers in the exercise's contract, and the names that the checks use."""

from __future__ import annotations

PACKAGE = "my_robot_package"
EXECUTABLE = "robot_controller"
NODE = "/robot_controller"

FORWARD = 0.3  # m/s
TURN = 0.5  # rad/s, to the left
PERIOD = 0.1  # s between two commands
SAFETY_DISTANCE = 1.0  # m: anything nearer ahead blocks the way
HALF_SECTOR = 30.0  # degrees to each side of straight ahead
STALE_AFTER = 0.5  # s: an older scan does not count
BLOCKED_SECONDS = 6.0  # s in front of a wall, for the checks of warnings
SILENT_SECONDS = 1.5  # s: the longest time without a warning while the way is blocked
MIN_WARNINGS = int(BLOCKED_SECONDS / SILENT_SECONDS)
TOLERANCE = 0.02  # m/s and rad/s: small enough to detect a speed that is 10 % wrong

RULE_FORWARD = "While the way is clear, linear.x = 0.3 and angular.z = 0."
RULE_TURN = "While something in front is nearer than 1 m, linear.x = 0 and angular.z = 0.5."
RULE_STOP = "A robot without a reading that it can trust stands still: publish a Twist() of zeros."
REP_117 = "https://www.ros.org/reps/rep-0117.html"
LASER_SCAN = "https://docs.ros.org/en/jazzy/p/sensor_msgs/msg/LaserScan.html"
QOS = "https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html"
NODES = "https://docs.ros.org/en/jazzy/Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Publisher-And-Subscriber.html"
