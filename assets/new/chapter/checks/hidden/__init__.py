"""The hidden checks of NEW_CHAPTER."""

PACKAGES = ("NEW_PACKAGE",)
MODULES = ("readings",)
