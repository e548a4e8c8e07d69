"""The checks of 04_launch."""
