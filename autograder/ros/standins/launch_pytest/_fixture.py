"""The decorator for fixtures that return a launch description."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest


@dataclass(frozen=True)
class LaunchOptions:
    """When the launch of a fixture ends."""

    shutdown_when_idle: bool
    auto_shutdown: bool


def fixture(
    decorated: Callable[..., Any] | None = None,
    *,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Return a fixture for a function that returns a launch description, or a sequence that starts with one.

    The description is launched before the first test that uses it, and shut down after the last one. With
    ``shutdown_when_idle=False``, the launch continues when nothing is left to do. With ``auto_shutdown=False``, the
    tests wait until it ends by itself. Other arguments, such as ``scope``, are passed to `pytest.fixture`.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        function._launch_pytest_options = LaunchOptions(shutdown_when_idle, auto_shutdown)  # type: ignore[attr-defined]
        return pytest.fixture(function, **kwargs)

    return decorate if decorated is None else decorate(decorated)
