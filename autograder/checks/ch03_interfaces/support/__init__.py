"""Code that the visible and the hidden checks of 03_interfaces share."""
