"""The fixtures of the visible checks serve the hidden ones, too."""

from autograder.visible.ch03_interfaces.conftest import (
    adviser,
    advisers,
    draw,
    driver,
    drivers,
    fresh_adviser,
    fresh_reporter,
    ready,
    reporter,
    reporters,
    types,
)

__all__ = [
    "adviser",
    "advisers",
    "draw",
    "driver",
    "drivers",
    "fresh_adviser",
    "fresh_reporter",
    "ready",
    "reporter",
    "reporters",
    "types",
]
