"""A lab in lockstep where that can be, and in real time where it cannot: the same checks, the same verdicts.

Whether a program can be stepped is found once. Where its package names nothing that could forbid it, it is taken for
steppable; else it is stepped for a second that nobody looks at.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from autograder.exceptions import StudentError
from autograder.lab.lockstep import LockstepLab
from autograder.lab.realtime import RealtimeLab
from autograder.lockstep import UnsteppableError
from autograder.lockstep.failures import say_unsteppable
from autograder.lockstep.protocol import REASONS

if TYPE_CHECKING:
    Base = LockstepLab
else:
    Base = object

LOCKSTEP, REAL = "lockstep", "real"
TIME_VARIABLE = "AUTOGRADER_TIME"  # "real" keeps every program from being stepped
PROBE_SECONDS = 1.0
MAX_READ = 4 * 1024 * 1024  # bytes of a package's Python files that are looked through
_WORDS = re.compile(rb"\b(threading|_?thread|asyncio|concurrent|multiprocessing|subprocess|sleep|Clock\w*|Executor)\b")

_reasons: dict[tuple[Any, ...], str] = {}  # why a program cannot be stepped, empty if it can
_met: dict[str, str] = {}  # by executable, the reason for each that was met in real time


def explain() -> str:
    """Say which programs were not stepped, and why; an empty string if all were."""
    said = [
        f"{name} was met in real time: {say_unsteppable(why) if why in REASONS else 'that was asked for'}."
        for name, why in sorted(_met.items())
    ]
    return " ".join(said)


class EitherLab(Base):
    """A `LockstepLab` for programs that can be stepped, else a `RealtimeLab`; made like these, used like these.

    Attributes:
        time: "lockstep" or "real".
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self._made_of = arguments, options
        self._handlers: dict[str, tuple[Any, Any]] = {}
        self._lab: Any = None
        self.time = LOCKSTEP

    def __enter__(self) -> Any:
        lab = self._make(LockstepLab)
        names = tuple((program.package, program.executable) for program in lab.programs)
        key = (names, *((path, path.stat().st_mtime_ns) for path in lab._paths))
        if os.environ.get(TIME_VARIABLE) == REAL:
            _reasons[key] = REAL
        if key not in _reasons:
            _reasons[key] = self._probe()
        if _reasons[key]:
            self.time = REAL
            _met.update({executable: _reasons[key] for _, executable in names})
            lab = self._make(RealtimeLab)
        self._lab = lab.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lab.__exit__(kind, error, trace)

    def serve(self, service_type: Any, name: str, handler: Any) -> None:
        if self._lab is None:
            self._handlers[name] = service_type, handler
        else:
            self._lab.serve(service_type, name, handler)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "_lab" or self._lab is None:
            raise AttributeError(f"{type(self).__name__} has no {name}, or not before it is entered")
        return getattr(self._lab, name)

    def _make(self, kind: Any) -> Any:
        arguments, options = self._made_of
        lab = kind(*arguments, **options)
        for name, (service_type, handler) in self._handlers.items():
            lab.serve(service_type, name, handler)
        return lab

    def _probe(self) -> str:
        """Return why the programs cannot be stepped, or an empty string.

        Other errors are left to the lab that is opened next.
        """
        lab = self._make(LockstepLab)
        if not any(_is_suspicious(lab._workspace.install / program.package) for program in lab.programs):
            return ""
        try:
            with lab:
                lab.run(PROBE_SECONDS)
                return str(next(iter(lab.notes), ""))
        except UnsteppableError as error:
            return error.reason
        except StudentError:
            return ""


def _is_suspicious(prefix: Path) -> bool:
    """Return whether an installed package names something that may keep its nodes from being stepped."""
    files = sorted(path for path in prefix.rglob("*.py") if path.is_file() and not path.is_symlink())
    left = MAX_READ
    for path in files:
        text = path.read_bytes()[:left]
        left -= len(text)
        if left <= 0 or _WORDS.search(text):
            return True
    return not files
