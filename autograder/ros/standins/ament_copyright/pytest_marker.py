"""The pytest plugin: makes the marker of copyright tests known."""

from __future__ import annotations

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known."""
    config.addinivalue_line("markers", "copyright: marks tests checking for correct copyright")
