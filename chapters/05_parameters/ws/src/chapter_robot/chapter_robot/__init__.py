"""The controller as a textbook prints it."""
