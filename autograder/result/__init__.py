"""The result of a grading, and the pictures that belong to it."""
