"""The hidden checks of 01_greeting."""

PACKAGES = ("greeting",)
MODULES = ("greet",)
