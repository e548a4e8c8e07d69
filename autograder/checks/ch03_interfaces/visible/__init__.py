"""The visible checks of 03_interfaces: some only read the definitions, so a build may fail."""

PACKAGES = ("my_robot_interfaces", "my_robot_package")
MODULES = ("definitions", "nodes")
BUILD_MAY_FAIL = True
