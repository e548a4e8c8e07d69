"""The hidden suite of 03_interfaces: definitions, the package that builds them, and the nodes that use them."""

PACKAGES = ("my_robot_interfaces", "my_robot_package")
MODULES = ("definitions", "package", "status", "service", "action", "goal_outcomes")
BUILD_MAY_FAIL = True
