"""The hidden suite of 01_package_structure: one package made by hand and one repaired, built or not."""

PACKAGES = ("square_dance", "wall_alarm")
MODULES = ("manifests", "install", "run", "repair")
BUILD_MAY_FAIL = True
READS = ("solutions/square_dance", "solutions/wall_alarm")  # on which the given tests are run
