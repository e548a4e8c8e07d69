"""The visible checks of 09_assessment: all questions are answered, and the system starts."""

PACKAGES = ("motor_guard_interfaces", "motor_guard")
MODULES = ("sheet", "system")
BUILD_MAY_FAIL = True
