"""The visible checks of 03_interfaces: they read the definitions, too, so a build may fail."""

PACKAGES = ("my_robot_interfaces", "my_robot_package")
MODULES = ("definitions", "nodes")
BUILD_MAY_FAIL = True
