"""A harness that runs programs in lockstep if possible, and otherwise in real time. Checks need not know which.

Whether a program can be stepped is determined once per grading. If nothing in its package could prevent it, the program
is assumed to be steppable. Any other program is first stepped for a second, in a trial that no check sees.
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

TIME_VARIABLE = "AUTOGRADER_TIME"  # "real" disables stepping
PROBE_SECONDS = 1.0  # ROS time for which programs are stepped in a trial
LATE_MESSAGE_SECONDS = 1.0  # maximum real time to wait for messages that a busy machine delays
MAX_READ = 4 * 1024 * 1024  # how many bytes of a package's Python files are searched
_SUSPICIOUS_WORDS = re.compile(
    rb"\b(threading|_?thread|asyncio|concurrent|multiprocessing|subprocess|sleep|Clock\w*|Executor)\b"
)

AnyAuto = TypeVar("AnyAuto", bound="AutoHarness")
AnyHarness = TypeVar("AnyHarness", bound=Harness)

if TYPE_CHECKING:
    Base = SteppedHarness  # `__getattr__` forwards its attributes; in real time, some do not exist
else:
    Base = object


class AutoHarness(Base):
    """A `SteppedHarness` if the programs can be stepped, else a `RealTimeHarness`, behind one interface.

    `time` is "lockstep" or "real".
    """

    def __init__(self, workspace: Workspace, *names: str, **options: Any) -> None:
        self._workspace, self._names, self._options = workspace, names, options
        self._optional: frozenset[str] = frozenset()
        self._harness: Harness | None = None
        self.time = LOCKSTEP

    if not TYPE_CHECKING:  # otherwise the type checker would accept any attribute

        def __getattr__(self, name: str) -> Any:
            if self._harness is None:
                raise RuntimeError(f"{type(self).__name__} is used before it is entered: write `with ... as harness`")
            return getattr(self._harness, name)

    def __enter__(self: AnyAuto) -> AnyAuto:
        stepped = self._make(SteppedHarness)
        reasons = self._reasons(stepped.programs)
        if reasons:
            self.time = REAL
            self._workspace.time_record.add_real_time([program.executable for program in stepped.programs], reasons)
        self._harness = (self._make(RealTimeHarness) if reasons else stepped).__enter__()
        return self

    def __exit__(self, *exc_info: Any) -> None:
        if self._harness is not None:
            self._harness.__exit__(*exc_info)

    @property
    def optional(self) -> frozenset[str]:
        return self._optional

    @optional.setter
    def optional(self, executables: frozenset[str]) -> None:
        self._optional = executables
        if self._harness is not None:
            self._harness.optional = executables

    @property
    def next_ns(self) -> int:
        """The ROS time in ns at which a program takes a message that is published now."""
        return self.now_ns + (self.tick_ns - 1 if self.time == LOCKSTEP else 0)

    def wait_for_late(self, condition: Callable[[], bool]) -> None:
        """Wait for late messages: in real time at most `LATE_MESSAGE_SECONDS`, in lockstep not at all."""
        if self.time == REAL:
            self.until(condition, LATE_MESSAGE_SECONDS)

    # The choice between lockstep and real time.

    def _make(self, kind: type[AnyHarness]) -> AnyHarness:
        harness = kind(self._workspace, *self._names, **self._options)
        harness.optional = self._optional
        return harness

    def _reasons(self, programs: tuple[Program, ...]) -> dict[str, str]:
        """Return why programs cannot be stepped, by executable. The result is cached until the grading ends."""
        if os.environ.get(TIME_VARIABLE) == REAL:
            return {program.executable: REAL for program in programs}
        files = [self._workspace.executable(program.package, program.executable) for program in programs]
        names = tuple((program.package, program.executable) for program in programs)
        key = (names, *((path, path.stat().st_mtime_ns) for path in files))
        cache = self._workspace.time_record.unsteppable
        if key not in cache:
            is_suspicious = any(_is_suspicious(self._workspace.install / program.package) for program in programs)
            cache[key] = self._probe() if is_suspicious else {}
        return cache[key]

    def _probe(self) -> dict[str, str]:
        """Step the programs for a second, and return why programs cannot be stepped, by executable.

        Other errors are ignored, because the harness that is entered next raises them again.
        """
        harness = self._make(SteppedHarness)
        # A failure of one program must not hide the reason of another.
        harness.optional = frozenset(program.executable for program in harness.programs)
        with suppress(StudentError), harness:
            harness.run(PROBE_SECONDS)
        return dict(harness.notes)


def _is_suspicious(prefix: Path) -> bool:
    """Return whether an installed package uses anything that may prevent stepping its nodes."""
    files = sorted(path for path in prefix.rglob("*.py") if path.is_file() and not path.is_symlink())
    remaining = MAX_READ
    for path in files:
        text = path.read_bytes()[:remaining]
        remaining -= len(text)
        if remaining <= 0 or _SUSPICIOUS_WORDS.search(text):
            return True
    return not files
