"""The visible checks of 02_nodes."""

PACKAGES = ("my_robot_package",)
MODULES = ("controller",)
