"""The hidden suite of 06_testing: students' tests have to pass on correct versions and fail on faulty ones."""

PACKAGES = ("speed_guard",)
MODULES = ("function", "node", "launch", "quality")
READS = ("solutions/speed_guard",)  # the versions of the package are created from it
