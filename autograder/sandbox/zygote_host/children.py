"""Another way for `subprocess` to make a child process, where there is one."""

from __future__ import annotations

import inspect
import subprocess
from collections.abc import Callable
from typing import Any

_PIPES = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
_KNOWN = [
    *("self", "args", "executable", "preexec_fn", "close_fds", "pass_fds", "cwd", "env", "startupinfo"),
    *("creationflags", "shell", *_PIPES),
    *("restore_signals", "gid", "gids", "uid", "umask", "start_new_session"),
]
_begin: Any = getattr(subprocess.Popen, "_execute_child", None)
KNOWN = _begin is not None and list(inspect.signature(_begin).parameters)[: len(_KNOWN)] == _KNOWN
"""Whether this Python's `subprocess` is one that is known here."""


def made_by(make: Callable[[Any, dict[str, Any]], int]) -> None:
    """Let `make` make the children of this process from now on; where `subprocess` is not known, nothing happens.

    Args:
        make: gets the command and all that `subprocess` knows of the child, by the names in CPython's
            `Popen._execute_child`; returns its process id, or 0 for a child that is made as before.
    """
    if not KNOWN:
        return
    before = subprocess.Popen._execute_child  # type: ignore[attr-defined]

    def execute(popen: Any, args: Any, *more: Any) -> None:
        given = dict(zip(_KNOWN[2:], more, strict=False))
        pid = make(args, given)
        if not pid:
            before(popen, args, *more)
            return
        popen.pid, popen._child_created = pid, True
        popen._close_pipe_fds(*[given[name] for name in _PIPES])

    subprocess.Popen._execute_child = execute  # type: ignore[attr-defined]


def streams(given: dict[str, Any]) -> tuple[int, int, int]:
    """Return the descriptors that a child gets as its standard streams, -1 for one of this process's own."""
    return given["p2cread"], given["c2pwrite"], given["errwrite"]
