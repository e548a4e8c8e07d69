"""The visible checks of 04_launch."""

PACKAGES = ("my_robot_bringup",)
MODULES = ("launches",)
