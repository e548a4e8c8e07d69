"""The action of a launch description that lets the tests start."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from launch import Action, LaunchContext
from standin_notice import make_getattr

__all__ = ["ReadyToTest"]


class ReadyToTest(Action):
    """Lets the tests start when it is executed."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], None]] = []

    def _add_callback(self, callback: Callable[[], None]) -> None:
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        """Let the tests start."""
        for callback in self._callbacks:
            try:
                callback()
            except Exception as error:
                logging.getLogger(__name__).error(error)


__getattr__ = make_getattr(__name__)
