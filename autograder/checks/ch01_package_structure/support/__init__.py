"""Code that the visible and the hidden checks of 01_package_structure share."""
