"""The description of a sandbox and of the files in it. No effects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from autograder.run.sandbox.limits import NODE, Limits

INTERPRETER = {
    "PYTHONHASHSEED": "0",
    "PYTHONUNBUFFERED": "1",
    "PYTHONDONTWRITEBYTECODE": "1",
    "PYTHONNOUSERSITE": "1",
    # Message packages import numpy: one thread of its library is quicker to start than one for each core.
    "OPENBLAS_NUM_THREADS": "1",
    "LANG": "C.UTF-8",
}
"""Environment variables that every Python of a workspace is started with."""


@dataclass(frozen=True)
class Mount:
    """A folder or file of the machine that the sandbox sees at the same path, or another one in its place.

    With `Isolation.PROCESS`, which mounts nothing, code sees what is at the path.
    """

    path: Path
    writable: bool = False
    source: Path | None = None  # what is seen in its place


@dataclass(frozen=True)
class View:
    """The part of the machine that a worker sandbox sees, besides the system, the grader and its scratch folder."""

    shown: tuple[Path, ...] = ()  # folders and files that it reads; they are read-only
    # The submission. Root's worker runs as another user, and may be unable to read it: it gets a copy.
    submitted: tuple[Path, ...] = ()
    writable: tuple[Path, ...] = ()  # folders that it writes to
    copies: Mapping[Path, Path] = field(default_factory=dict)  # the path to show in the place of another one


@dataclass(frozen=True)
class Sandbox:
    """One sandbox: visible files, resource limits and environment."""

    workdir: Path  # the working folder, inside a mount
    # Beyond the read-only system and the grader's Python; suites and solutions in them are covered.
    mounts: tuple[Mount, ...] = ()
    # All environment variables that the code gets, nothing is inherited.
    environment: Mapping[str, str] = field(default_factory=dict)
    network: bool = False  # True: the loopback of the worker sandbox, to reach the grader over DDS; False: none
    limits: Limits = NODE  # the resource limits of the tree
