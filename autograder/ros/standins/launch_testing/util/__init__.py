"""A process that keeps a launch running, and the search for processes."""

from __future__ import annotations

import sys

from launch.actions import ExecuteProcess
from standin_notice import make_getattr

from .proc_lookup import NO_CMD_ARGS, NoMatchingProcessException, resolveProcesses

__all__ = ["NO_CMD_ARGS", "KeepAliveProc", "NoMatchingProcessException", "resolveProcesses"]

_WAIT = "import signal\ntry:\n    signal.pause()\nexcept KeyboardInterrupt:\n    pass\n"


def KeepAliveProc() -> ExecuteProcess:  # the name in the real package
    """Return a process that does nothing until the launch is shut down, and so keeps it running."""
    return ExecuteProcess(cmd=[sys.executable, "-c", _WAIT])


__getattr__ = make_getattr(__name__)
