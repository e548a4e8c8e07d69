"""A harness in lockstep where that is possible, and in real time where it is not: checks need not know.

Whether a program can be stepped is found once in a grading. A program whose package names nothing that could forbid it
is taken for steppable; any other is stepped for a second that no check looks at.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from autograder.exceptions import StudentError
from autograder.harness.base import Harness, Program
from autograder.harness.real_time import RealTimeHarness
from autograder.harness.stepped import SteppedHarness
from autograder.run.time_record import LOCKSTEP, REAL
from autograder.run.workspace import Workspace

TIME_VARIABLE = "AUTOGRADER_TIME"  # "real" keeps every program from being stepped
PROBE_SECONDS = 1.0
LATE_MESSAGE_SECONDS = 1.0  # for delays by a busy machine in real time
MAX_READ = 4 * 1024 * 1024  # bytes of a package's Python files that are looked through
_WORDS = re.compile(rb"\b(threading|_?thread|asyncio|concurrent|multiprocessing|subprocess|sleep|Clock\w*|Executor)\b")

AnyAuto = TypeVar("AnyAuto", bound="AutoHarness")
AnyHarness = TypeVar("AnyHarness", bound=Harness)

if TYPE_CHECKING:
    Base = SteppedHarness  # attributes by `__getattr__`; those of SteppedHarness only if stepped
else:
    Base = object


class AutoHarness(Base):
    """A `SteppedHarness` for programs that can be stepped, else a `RealTimeHarness`; made and used like these.

    `time` is "lockstep" or "real".
    """

    def __init__(self, workspace: Workspace, *names: str, **options: Any) -> None:
        self._workspace, self._names, self._options = workspace, names, options
        self._optional: frozenset[str] = frozenset()
        self._entered: Harness | None = None
        self.time = LOCKSTEP

    if not TYPE_CHECKING:  # the type checker would take any name

        def __getattr__(self, name: str) -> Any:
            if self._entered is None:
                raise RuntimeError(f"{type(self).__name__} is used before it is entered: write `with ... as harness`")
            return getattr(self._entered, name)

    def __enter__(self: AnyAuto) -> AnyAuto:
        stepped = self._make(SteppedHarness)
        reasons = self._reasons(stepped.programs)
        if reasons:
            self.time = REAL
            self._workspace.time_record.add_real_time([program.executable for program in stepped.programs], reasons)
        self._entered = (self._make(RealTimeHarness) if reasons else stepped).__enter__()
        return self

    def __exit__(self, *ending: Any) -> None:
        if self._entered is not None:
            self._entered.__exit__(*ending)

    @property
    def optional(self) -> frozenset[str]:
        return self._optional

    @optional.setter
    def optional(self, executables: frozenset[str]) -> None:
        self._optional = executables
        if self._entered is not None:
            self._entered.optional = executables

    @property
    def next_ns(self) -> int:
        """The ROS time in ns at which a program takes a message that is published now."""
        return self.now_ns + (self.tick_ns - 1 if self.time == LOCKSTEP else 0)

    def wait_for_late(self, condition: Callable[[], bool]) -> None:
        """Wait for late messages: in real time at most `LATE_MESSAGE_SECONDS`, in lockstep not at all."""
        if self.time == REAL:
            self.until(condition, LATE_MESSAGE_SECONDS)

    # The choice.

    def _make(self, kind: type[AnyHarness]) -> AnyHarness:
        harness = kind(self._workspace, *self._names, **self._options)
        harness.optional = self._optional
        return harness

    def _reasons(self, programs: tuple[Program, ...]) -> dict[str, str]:
        """Return by executable why a program cannot be stepped, for those that cannot; found once in a grading."""
        if os.environ.get(TIME_VARIABLE) == REAL:
            return {program.executable: REAL for program in programs}
        files = [self._workspace.executable(program.package, program.executable) for program in programs]
        names = tuple((program.package, program.executable) for program in programs)
        key = (names, *((path, path.stat().st_mtime_ns) for path in files))
        known = self._workspace.time_record.unsteppable
        if key not in known:
            suspicious = any(_is_suspicious(self._workspace.install / program.package) for program in programs)
            known[key] = self._probe() if suspicious else {}
        return known[key]

    def _probe(self) -> dict[str, str]:
        """Step the programs for a second; return by executable why a program cannot be stepped.

        Other errors are left to the harness that is opened next.
        """
        harness = self._make(SteppedHarness)
        harness.optional = frozenset(program.executable for program in harness.programs)  # none hides another's reason
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
