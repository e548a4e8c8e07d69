"""The hidden suite of 03_interfaces: definitions, the package that builds them, and nodes that use them on the wire."""

PACKAGES = ("my_robot_interfaces", "my_robot_package")
MODULES = ("definitions", "package", "status", "service", "action", "endings")
BUILD_MAY_FAIL = True
