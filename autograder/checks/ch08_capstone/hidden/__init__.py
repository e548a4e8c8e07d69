"""The hidden suite of 08_capstone: two packages from an empty folder, and a robot that finds its way."""

PACKAGES = ("robot_navigation_interfaces", "robot_navigation_tutorial")
MODULES = (
    "package",
    "messages",
    "nodes",
    "clearances",
    "commands",
    "health",
    "worlds",
    "launches",
    "parameters",
    "tests",
    "quality",
)
BUILD_MAY_FAIL = True
OWN_TESTS = ("linters_pass", "tests_pass")
