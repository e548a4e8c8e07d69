"""Code that the visible and the hidden checks of 06_testing share."""
