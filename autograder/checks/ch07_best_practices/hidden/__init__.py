"""The hidden suite of 07_best_practices: utilities that keep every beam, and nodes that tolerate errors."""

PACKAGES = ("my_robot_package",)
MODULES = ("utils", "processor", "robust")
