"""The hidden checks of 08_capstone, whose two packages students write from an empty folder."""

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
GROUPS = tuple(f"step_{number}" for number in range(1, 8))  # step 3 runs before step 2, which needs its messages
READS = ("solutions/robot_navigation_tutorial",)  # contains the given integration test
BUILD_MAY_FAIL = True
OWN_TESTS = ("linters_pass", "tests_pass")
