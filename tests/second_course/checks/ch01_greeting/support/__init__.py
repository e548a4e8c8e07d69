"""Code that the visible and the hidden checks of 01_greeting share."""
