"""The visible checks of 00_welcome, which has no hidden checks and no points."""

PACKAGES = ("first_robot",)
MODULES = ("square",)
