"""A harness in lockstep where that is possible, and in real time where it is not: checks need not know.

Whether a program can be stepped is found once in a grading. A program whose package names nothing that could forbid it
is taken for steppable; any other is stepped for a second that no check looks at.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

from rclpy.node import Node

from autograder.exceptions import StudentError
from autograder.harness.base import Harness
from autograder.harness.goals import Goal, Stamped
from autograder.harness.grader_node import Handler
from autograder.harness.programs import Program
from autograder.harness.real_time import RealTimeHarness
from autograder.harness.stepped import SteppedHarness
from autograder.sandbox import Process
from autograder.time_record import LOCKSTEP, REAL
from autograder.workspace import Workspace

TIME_VARIABLE = "AUTOGRADER_TIME"  # "real" keeps every program from being stepped
PROBE_SECONDS = 1.0
PATIENCE = 1.0  # s for an answer in real time
MAX_READ = 4 * 1024 * 1024  # bytes of a package's Python files that are looked through
_WORDS = re.compile(rb"\b(threading|_?thread|asyncio|concurrent|multiprocessing|subprocess|sleep|Clock\w*|Executor)\b")

AnyAuto = TypeVar("AnyAuto", bound="AutoHarness")
AnyHarness = TypeVar("AnyHarness", bound=Harness)


class AutoHarness:
    """A `SteppedHarness` for programs that can be stepped, else a `RealTimeHarness`; made like these, used like these.

    What is not documented here is as in `Harness`.

    Attributes:
        time: "lockstep" or "real".
    """

    def __init__(
        self,
        workspace: Workspace,
        package: str = "",
        executable: str = "",
        *,
        programs: tuple[Program, ...] = (),
        offers: Mapping[str, type] | None = None,
        listens: Mapping[str, type] | None = None,
        arguments: tuple[str, ...] = (),
        files: Mapping[str, str] | None = None,
    ) -> None:
        def make(kind: type[AnyHarness]) -> AnyHarness:
            return kind(
                workspace,
                package,
                executable,
                programs=programs,
                offers=offers,
                listens=listens,
                arguments=arguments,
                files=files,
            )

        self._make_plain = make
        self._workspace = workspace
        self._handlers: dict[str, tuple[Any, Handler]] = {}
        self._optional: frozenset[str] = frozenset()
        self._entered: Harness | None = None
        self.time = LOCKSTEP

    def __enter__(self: AnyAuto) -> AnyAuto:
        stepped = self._make(SteppedHarness)
        reasons = self._reasons(stepped.programs)
        if reasons:
            self.time = REAL
            self._workspace.time_record.add_real_time([program.executable for program in stepped.programs], reasons)
        self._entered = (self._make(RealTimeHarness) if reasons else stepped).__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._harness.__exit__(kind, error, trace)

    # What it has beyond a harness of either kind.

    @property
    def next_ns(self) -> int:
        """The ROS time in ns at which a program takes what is published now."""
        return self.now_ns + (self.tick_ns - 1 if self.time == LOCKSTEP else 0)

    def wait_for_late(self, condition: Callable[[], bool], seconds: float = PATIENCE) -> None:
        """Wait for what a busy machine may hold up: in real time at most `seconds`, in lockstep not at all."""
        if self.time == REAL:
            self.until(condition, seconds)

    # What can be set before it is entered.

    @property
    def optional(self) -> frozenset[str]:
        """Executables that may fail: the others run on without them."""
        return self._optional

    @optional.setter
    def optional(self, executables: frozenset[str]) -> None:
        self._optional = executables
        if self._entered is not None:
            self._entered.optional = executables

    def serve(self, service_type: Any, name: str, handler: Handler) -> None:
        if self._entered is None:
            self._handlers[name] = service_type, handler
        else:
            self._entered.serve(service_type, name, handler)

    # What it passes on to the harness that was chosen.

    @property
    def node(self) -> Node:
        return self._harness.node

    @property
    def tick_ns(self) -> int:
        return self._harness.tick_ns

    @property
    def now_ns(self) -> int:
        return self._harness.now_ns

    @property
    def seconds(self) -> float:
        return self._harness.seconds

    @property
    def processes(self) -> tuple[Process, ...]:
        return self._harness.processes

    @property
    def process(self) -> Process:
        return self._harness.process

    @property
    def running(self) -> frozenset[str]:
        return self._harness.running

    @property
    def output(self) -> str:
        return self._harness.output

    @property
    def discovery_seconds(self) -> float:
        return self._harness.discovery_seconds

    def nodes(self) -> list[str]:
        return self._harness.nodes()

    def takes(self, topic: str) -> bool:
        return self._harness.takes(topic)

    def publish(self, topic: str, message: Any) -> None:
        self._harness.publish(topic, message)

    def messages(self, topic: str, **bounds: float) -> list[Stamped]:
        return self._harness.messages(topic, **bounds)

    def rate(self, topic: str, since: float) -> float:
        return self._harness.rate(topic, since)

    def step(self, dt_ns: int) -> None:
        self._harness.step(dt_ns)

    def run(self, seconds: float) -> None:
        self._harness.run(seconds)

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        return self._harness.until(condition, seconds)

    def wait_for(self, condition: Callable[[], bool], seconds: float) -> bool:
        return self._harness.wait_for(condition, seconds)

    def call(self, service_type: Any, name: str, request: Any, seconds: float = 5.0) -> Any:
        return self._harness.call(service_type, name, request, seconds)

    def send_goal(self, action_type: Any, name: str, goal: Any, seconds: float = 5.0) -> Goal:
        return self._harness.send_goal(action_type, name, goal, seconds)

    @property
    def _harness(self) -> Harness:
        """The harness that was chosen.

        Raises:
            RuntimeError: this harness is not entered.
        """
        if self._entered is None:
            raise RuntimeError(f"{type(self).__name__} is used before it is entered: write `with ... as harness`")
        return self._entered

    # The choice.

    def _make(self, kind: type[AnyHarness]) -> AnyHarness:
        harness = self._make_plain(kind)
        harness.optional = self._optional
        for name, (service_type, handler) in self._handlers.items():
            harness.serve(service_type, name, handler)
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
