"""Code that the visible and the hidden checks of 02_nodes share."""
