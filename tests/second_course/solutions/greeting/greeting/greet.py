"""Greet a robot."""


def greet(name):
    """Return a greeting of a robot by its name, without spaces around it."""
    return f"Hello, {name.strip()}!"
