"""The visible checks of 06_testing."""

PACKAGES = ("speed_guard",)
MODULES = ("mutants",)
