"""The hidden checks of 02_beat."""

PACKAGES = ("beat",)
MODULES = ("beat",)
