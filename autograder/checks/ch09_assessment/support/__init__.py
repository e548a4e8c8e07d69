"""Code that the visible and the hidden checks of 09_assessment share."""
