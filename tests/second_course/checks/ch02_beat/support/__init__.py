"""Code that the visible and the hidden checks of 02_beat share."""
