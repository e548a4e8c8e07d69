"""Code that the visible and the hidden checks of 05_parameters share."""
