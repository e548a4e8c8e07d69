"""The checks of 05_parameters."""
