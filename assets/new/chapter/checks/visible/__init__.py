"""The visible checks of NEW_CHAPTER."""

PACKAGES = ("NEW_PACKAGE",)
MODULES = ("nearest",)
