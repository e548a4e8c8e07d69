"""The end of a forked program: what it has made is taken apart as ever, what it shares with the zygote is left alone.

An interpreter that ends clears every module, and the libraries clear up behind it. A forked one would have to copy most
of the zygote's memory for that, page by page, which costs more than the program's start.
"""

from __future__ import annotations

import atexit
import ctypes
import gc
import os
import signal
import sys
import weakref
from types import ModuleType, TracebackType
from typing import Any

_LAST = ("last_type", "last_value", "last_traceback", "last_exc")
_OPENED = ("rclpy", "rclpy.utilities")  # inherited modules whose globals hold what a program opens


class Leaving:
    """The end of this process's program; a context manager around it.

    Make it before other modules are imported: what is registered with `atexit` first is called last.

    Args:
        stage: the namespace from which the program is run; it holds the program's own, and is cleared.
    """

    def __init__(self, stage: dict[str, Any]) -> None:
        self._stage = stage
        self._inherited: frozenset[str] = frozenset()
        self._status = 0
        self._interrupted = False
        atexit.register(self._leave)

    def __enter__(self) -> None:
        self._inherited = frozenset(sys.modules) - {"__main__", *_OPENED}

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._interrupted = isinstance(error, KeyboardInterrupt)
        self._status = _status_of(error)

    def _leave(self) -> None:
        """End, after Python has told of an error, has waited for threads and has called all else that is to be called.

        Where the output cannot be written, Python's own end says so.
        """
        if not self._inherited or not _flushed():
            return
        self._stage.clear()
        _take_apart(self._inherited, id(vars(sys.modules["__main__"])))
        if not _flushed():
            return
        ctypes.CDLL(None).fflush(None)  # what libraries have written
        if self._interrupted:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            os.kill(os.getpid(), signal.SIGINT)
        os._exit(self._status)


def _status_of(error: BaseException | None) -> int:
    """Return the exit status that Python has after an error."""
    if not isinstance(error, SystemExit):
        return int(error is not None)
    code = error.code
    if isinstance(code, int):
        return code & 0xFF if code.bit_length() < 64 else 0xFF
    return int(code is not None)


def _flushed() -> bool:
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None and not stream.closed:
                stream.flush()
    except BaseException:
        return False
    return True


def _take_apart(inherited: frozenset[str], globals_id: int) -> None:
    """Do what CPython's `finalize_modules` does, with the modules that were not inherited.

    Globals of the program that live on then are held by a module that was: they are cleared, too.
    """
    for name in _LAST:
        if hasattr(sys, name):
            delattr(sys, name)
    own = [sys.modules.pop(name) for name in [*sys.modules] if name not in inherited]
    left = [weakref.ref(module) for module in reversed(own) if isinstance(module, ModuleType)]
    del own
    gc.collect()
    for reference in left:
        module = reference()
        if module is not None:
            _clear(vars(module))
    for kept in [kept for kept in gc.get_objects() if id(kept) == globals_id]:
        _clear(kept)
    gc.collect()


def _clear(space: dict[str, Any]) -> None:
    """Set a module's globals to None, those with one leading underscore first."""
    for private in (True, False):
        for name in [*space]:
            if name != "__builtins__" and (not private or (name.startswith("_") and name[1:2] != "_")):
                space[name] = None
