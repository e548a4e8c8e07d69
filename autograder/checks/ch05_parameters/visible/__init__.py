"""The visible checks of 05_parameters."""

PACKAGES = ("my_robot_package",)
MODULES = ("declared", "changed", "parameter_file")
