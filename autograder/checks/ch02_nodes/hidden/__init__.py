"""The hidden suite of 02_nodes: a robot controller that drives, turns, and stands still when it is blind."""

PACKAGES = ("my_robot_package",)
MODULES = ("graph", "reaction", "readings", "safety", "timing", "lifecycle", "worlds")
