"""The checks of 07_best_practices."""
