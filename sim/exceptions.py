"""The exceptions of the simulator.

    SimError
    ├── WorldError       a world, in a file or in code, that cannot be used
    ├── SpecError        a robot, a lidar, a fault or a run with invalid values
    ├── EngineError      an engine that is unknown or not installed
    └── RecordingError   a recording that cannot be read or replayed

Each message names the place of the error, the problem and a remedy.
"""

from __future__ import annotations


class SimError(Exception):
    """The base class of the simulator's exceptions."""


class WorldError(SimError):
    """A world that cannot be used.

    `path` is the file and `line` its line, counted from 1, if they are known. `problem` describes the error, and
    `remedy` says what to do.
    """

    def __init__(self, problem: str, remedy: str = "", *, path: str = "", line: int | None = None) -> None:
        self.problem = problem
        self.remedy = remedy
        self.path = path
        self.line = line
        place = f"{path or 'world'}:{line}: " if line is not None else f"{path}: " if path else ""
        super().__init__(f"{place}{problem}" + (f". {remedy}." if remedy else ""))


class SpecError(SimError, ValueError):
    """A description of a robot, a lidar, a fault or a run with invalid values."""


class EngineError(SimError):
    """An engine that does not exist, or whose library is not installed."""


class RecordingError(SimError):
    """A recording that cannot be read or replayed."""
