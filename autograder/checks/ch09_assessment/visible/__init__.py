"""The visible checks of 09_assessment: is everything answered, and does what was built start?"""

PACKAGES = ("motor_guard_interfaces", "motor_guard")
MODULES = ("sheet", "system")
BUILD_MAY_FAIL = True
