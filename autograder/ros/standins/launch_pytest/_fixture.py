"""The decorator that makes a launch description from a fixture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest


@dataclass(frozen=True)
class Options:
    """How the launch of a fixture ends."""

    shutdown_when_idle: bool
    auto_shutdown: bool


def fixture(
    decorated: Callable[..., Any] | None = None,
    *,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Make a fixture of a function that returns a launch description, or a sequence that begins with one.

    The description is launched before the first test that uses it and shut down after the last one. With
    ``shutdown_when_idle=False`` the launch goes on when nothing is left to do, and with
    ``auto_shutdown=False`` the tests wait for it to end of its own. Further arguments, such as ``scope``, go
    to `pytest.fixture`.
    """

    def decorate(function: Callable[..., Any]) -> Any:
        function._launch_pytest_options = Options(shutdown_when_idle, auto_shutdown)  # type: ignore[attr-defined]
        return pytest.fixture(function, **kwargs)

    return decorate if decorated is None else decorate(decorated)
