"""The visible checks of 01_greeting."""

PACKAGES = ("greeting",)
MODULES = ("greet",)
