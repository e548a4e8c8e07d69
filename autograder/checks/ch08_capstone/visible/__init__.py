"""The visible checks of 08_capstone, one or more for each step."""

PACKAGES = ("robot_navigation_interfaces", "robot_navigation_tutorial")
MODULES = ("files", "behaviour", "system")
GROUPS = tuple(f"step_{number}" for number in range(1, 8))
BUILD_MAY_FAIL = True
