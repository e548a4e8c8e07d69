"""Code that the visible and the hidden checks of 08_capstone share."""
