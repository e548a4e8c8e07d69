"""Every error that the simulator raises on purpose.

    SimError
    ├── WorldError       a world, in a file or in code, that cannot be used
    ├── SpecError        a robot, a lidar, a fault or a run described with values that make no sense
    ├── EngineError      an engine that is unknown or not installed
    └── RecordingError   a recording that cannot be read or replayed

Each message names where the trouble is, what is wrong, and what to do about it.
"""

from __future__ import annotations


class SimError(Exception):
    """The base of the simulator's errors."""


class WorldError(SimError):
    """A world that cannot be used.

    `path` is the file and `line` the line in it, counted from 1, where they are known; `problem` says what is
    wrong and `remedy` what to do.
    """

    def __init__(self, problem: str, remedy: str = "", *, path: str = "", line: int | None = None) -> None:
        self.problem = problem
        self.remedy = remedy
        self.path = path
        self.line = line
        where = f"{path or 'world'}:{line}: " if line is not None else f"{path}: " if path else ""
        super().__init__(f"{where}{problem}" + (f". {remedy}." if remedy else ""))


class SpecError(SimError, ValueError):
    """A description of a robot, a lidar, a fault or a run that makes no sense."""


class EngineError(SimError):
    """An engine that does not exist, or whose library is not installed."""


class RecordingError(SimError):
    """A recording that cannot be read or replayed."""
