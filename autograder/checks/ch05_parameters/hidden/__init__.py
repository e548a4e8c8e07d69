"""The hidden suite of 05_parameters: declared, set at the start, changed at run time, and kept in a file."""

PACKAGES = ("my_robot_package",)
MODULES = ("declaration", "start_values", "changes", "files")
