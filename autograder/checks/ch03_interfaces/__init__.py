"""The checks of 03_interfaces."""
