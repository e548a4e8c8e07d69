"""The pytest plugin, which registers the marker of copyright tests."""

from __future__ import annotations

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker."""
    config.addinivalue_line("markers", "copyright: marks tests checking for correct copyright")
