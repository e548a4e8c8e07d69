"""The visible checks of 00_welcome; it has no hidden checks and no points."""

PACKAGES = ("first_robot",)
MODULES = ("square",)
