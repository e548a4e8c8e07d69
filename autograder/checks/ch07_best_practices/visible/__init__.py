"""The visible checks of 07_best_practices."""

PACKAGES = ("my_robot_package",)
MODULES = ("practices",)
