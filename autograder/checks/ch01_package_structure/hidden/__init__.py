"""The hidden suite of 01_package_structure: a package made by hand and a repaired one. The build may fail."""

PACKAGES = ("square_dance", "wall_alarm")
MODULES = ("manifests", "install", "run", "repair")
BUILD_MAY_FAIL = True
READS = ("solutions/square_dance", "solutions/wall_alarm")  # the given tests are run on copies of them
