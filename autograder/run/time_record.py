"""Records which programs of a grading ran in real time, and why, and how long a busy machine delayed them."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field

from autograder.run.lockstep.failures import UNSTEPPABLE

LOCKSTEP, REAL = "lockstep", "real"


@dataclass
class TimeRecord:
    """The record of one grading. The workspace passes it to the harnesses, and the worker reads it at the end.

    Attributes:
        unsteppable: for the programs of each harness, why executables cannot be stepped.
        real_time: why each of these executables ran in real time; empty if another program is the reason.
        longest_wait: the longest time in s for which a program or the grader could not run although it was ready.
    """

    unsteppable: dict[Hashable, dict[str, str]] = field(default_factory=dict)
    real_time: dict[str, str] = field(default_factory=dict)
    longest_wait: float = 0.0

    def add_wait(self, seconds: float) -> None:
        """Record a waiting time in s if it is the longest so far."""
        self.longest_wait = max(self.longest_wait, seconds)

    def add_real_time(self, executables: Iterable[str], reasons: dict[str, str]) -> None:
        """Record that programs run in real time together. For some of them, `reasons` has a key of `UNSTEPPABLE`."""
        for executable in executables:
            self.real_time[executable] = reasons.get(executable) or self.real_time.get(executable, "")

    @property
    def time(self) -> str:
        """`LOCKSTEP` if every program was stepped, else `REAL`."""
        return REAL if self.explain() else LOCKSTEP

    def explain(self) -> str:
        """Return sentences that say which programs were not stepped, and why, or an empty string if all were."""
        sentences = [
            f"{name} ran in real time, because {UNSTEPPABLE.get(reason, 'this was requested')}."
            for name, reason in sorted(self.real_time.items())
            if reason
        ]
        other_programs = ", ".join(sorted(name for name, reason in self.real_time.items() if not reason))
        return " ".join(
            [*sentences, f"Programs that run alongside it also ran in real time: {other_programs}."]
            if other_programs
            else sentences
        )
