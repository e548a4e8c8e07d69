"""Code that the visible and the hidden checks of 07_best_practices share."""
