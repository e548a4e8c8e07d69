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
GROUPS = tuple(f"step_{number}" for number in range(1, 8))  # step 2 needs the messages of step 3, which is run first
READS = ("solutions/robot_navigation_tutorial",)  # the given test of the whole system
BUILD_MAY_FAIL = True
OWN_TESTS = ("linters_pass", "tests_pass")
