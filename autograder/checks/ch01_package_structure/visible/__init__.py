"""The visible checks of 01_package_structure: they look at the packages' files, too, so a build may fail."""

PACKAGES = ("square_dance", "wall_alarm")
MODULES = ("packages",)
BUILD_MAY_FAIL = True
