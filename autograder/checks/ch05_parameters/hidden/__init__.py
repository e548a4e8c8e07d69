"""The hidden suite of 05_parameters: declaring, setting, changing and storing parameters."""

PACKAGES = ("my_robot_package",)
MODULES = ("declaration", "start_values", "changes", "files")
