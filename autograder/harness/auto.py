"""A harness in lockstep where that can be, and in real time where it cannot: the same checks, the same verdicts.

Whether a program can be stepped is found once. Where its package names nothing that could forbid it, it is taken for
steppable; else it is stepped for a second that nobody looks at.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from autograder.exceptions import StudentError
from autograder.harness.real_time import RealTimeHarness
from autograder.harness.stepped import SteppedHarness
from autograder.lockstep.failures import say_unsteppable
from autograder.lockstep.protocol import REASONS

if TYPE_CHECKING:
    Base = SteppedHarness
else:
    Base = object

LOCKSTEP, REAL = "lockstep", "real"
TIME_VARIABLE = "AUTOGRADER_TIME"  # "real" keeps every program from being stepped
PROBE_SECONDS = 1.0
PATIENCE = 1.0  # s for an answer in real time
MAX_READ = 4 * 1024 * 1024  # bytes of a package's Python files that are looked through
_WORDS = re.compile(rb"\b(threading|_?thread|asyncio|concurrent|multiprocessing|subprocess|sleep|Clock\w*|Executor)\b")

_reasons: dict[tuple[Any, ...], dict[str, str]] = {}  # of a harness's programs, why those that cannot be stepped cannot
_met: dict[str, str] = {}  # by executable, the reason for each that was met in real time; empty if it is another's


def explain() -> str:
    """Say which programs were not stepped, and why; an empty string if all were."""
    said = [
        f"{name} was met in real time: {say_unsteppable(why) if why in REASONS else 'that was asked for'}."
        for name, why in sorted(_met.items())
        if why
    ]
    beside = ", ".join(sorted(name for name, why in _met.items() if not why))
    return " ".join([*said, f"So was what runs beside it: {beside}."] if beside else said)


class AutoHarness(Base):
    """A `SteppedHarness` for programs that can be stepped, else a `RealTimeHarness`; made like these, used like these.

    Attributes:
        time: "lockstep" or "real".
        spared: executables that may fail: the others live on without them.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self._made_of = arguments, options
        self._handlers: dict[str, tuple[Any, Any]] = {}
        self._spared: frozenset[str] = frozenset()
        self._harness: Any = None
        self.time = LOCKSTEP

    def __enter__(self) -> Any:
        harness = self._make(SteppedHarness)
        names = tuple((program.package, program.executable) for program in harness.programs)
        key = (names, *((path, path.stat().st_mtime_ns) for path in harness._paths))
        if os.environ.get(TIME_VARIABLE) == REAL:
            _reasons[key] = {executable: REAL for _, executable in names}
        if key not in _reasons:
            _reasons[key] = self._probe()
        if reasons := _reasons[key]:
            self.time = REAL
            for _, executable in names:
                _met[executable] = reasons.get(executable) or _met.get(executable, "")
            harness = self._make(RealTimeHarness)
        self._harness = harness.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._harness.__exit__(kind, error, trace)

    @property
    def spared(self) -> frozenset[str]:
        return self._spared

    @spared.setter
    def spared(self, executables: frozenset[str]) -> None:
        self._spared = executables
        if self._harness is not None:
            self._harness.spared = executables

    @property
    def next_ns(self) -> int:
        """The ROS time at which a program takes what is published now."""
        return int(self.now_ns) + (self.tick_ns - 1 if self.time == LOCKSTEP else 0)

    def wait_for_late(self, condition: Callable[[], bool], seconds: float = PATIENCE) -> None:
        """Wait for what a busy machine may hold up: in real time at most `seconds`, in lockstep not at all."""
        if self.time == REAL:
            self.until(condition, seconds)

    def serve(self, service_type: Any, name: str, handler: Any) -> None:
        if self._harness is None:
            self._handlers[name] = service_type, handler
        else:
            self._harness.serve(service_type, name, handler)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "_harness" or self._harness is None:
            raise AttributeError(f"{type(self).__name__} has no {name}, or not before it is entered")
        return getattr(self._harness, name)

    def _make(self, kind: Any) -> Any:
        arguments, options = self._made_of
        harness = kind(*arguments, **options)
        harness.spared = self._spared
        for name, (service_type, handler) in self._handlers.items():
            harness.serve(service_type, name, handler)
        return harness

    def _probe(self) -> dict[str, str]:
        """Return by executable why a program cannot be stepped, for those that cannot.

        Other errors are left to the harness that is opened next.
        """
        harness = self._make(SteppedHarness)
        if not any(_is_suspicious(harness._workspace.install / program.package) for program in harness.programs):
            return {}
        harness.spared = frozenset(program.executable for program in harness.programs)  # none hides another by failing
        with suppress(StudentError), harness:
            harness.run(PROBE_SECONDS)
        return dict(harness.notes)


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
