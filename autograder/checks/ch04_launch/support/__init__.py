"""Code that the visible and the hidden checks of 04_launch share."""
