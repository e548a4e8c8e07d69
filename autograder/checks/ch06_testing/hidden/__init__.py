"""The hidden suite of 06_testing: a student's tests pass on right versions of a package, and fail on faulty ones."""

PACKAGES = ("speed_guard",)
MODULES = ("function", "node", "launch", "quality")
READS = ("solutions/speed_guard",)  # the versions of the package are created from it
