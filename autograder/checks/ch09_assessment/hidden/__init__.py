"""The hidden suite of 09_assessment: the key to the questions, and checks of a small system."""

PACKAGES = ("motor_guard_interfaces", "motor_guard")
FOLDERS = ("assessment",)
MODULES = ("choices", "packages", "nodes", "launches")
BUILD_MAY_FAIL = True
