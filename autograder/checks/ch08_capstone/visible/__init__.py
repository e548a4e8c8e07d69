"""The visible checks of 08_capstone, one or two a step."""

PACKAGES = ("robot_navigation_interfaces", "robot_navigation_tutorial")
MODULES = ("files", "behaviour", "system")
BUILD_MAY_FAIL = True
