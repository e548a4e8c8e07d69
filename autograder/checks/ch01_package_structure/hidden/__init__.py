"""The hidden suite of 01_package_structure: a package that is made by hand, and one that is repaired."""

PACKAGES = ("square_dance", "wall_alarm")
MODULES = ("manifests", "install", "run", "repair")
BUILD_MAY_FAIL = True
READS = ("solutions/square_dance", "solutions/wall_alarm")  # the given tests run on copies of these solutions
