"""The visible checks of 00_welcome; it has no hidden ones, and no points."""

PACKAGES = ("first_robot",)
MODULES = ("square",)
