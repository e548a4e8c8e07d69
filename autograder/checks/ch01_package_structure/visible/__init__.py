"""The visible checks of 01_package_structure: some only read the packages' files, so a build may fail."""

PACKAGES = ("square_dance", "wall_alarm")
MODULES = ("packages",)
BUILD_MAY_FAIL = True
