"""The checks of 01_package_structure."""
