"""The checks of 09_assessment."""
