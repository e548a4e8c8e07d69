"""Code that the visible and the hidden checks of NEW_CHAPTER share."""
