"""A process that keeps a launch from being idle."""

from __future__ import annotations

import sys
from typing import Any

from launch.actions import ExecuteProcess
from standin_notice import guard

__all__ = ["KeepAliveProc"]

_WAIT = "import signal\ntry:\n    signal.pause()\nexcept KeyboardInterrupt:\n    pass\n"


class KeepAliveProc(ExecuteProcess):
    """Does nothing until the launch ends, so that the launch does not end when nothing else is left to do."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(cmd=[sys.executable, "-c", _WAIT], name="keep_alive", **kwargs)


__getattr__ = guard(__name__)
