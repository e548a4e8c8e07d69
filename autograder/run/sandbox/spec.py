"""Describes sandboxes and the files that are visible in them, without side effects."""

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
    # Message packages import numpy, whose library starts faster with one thread than with one for each core.
    "OPENBLAS_NUM_THREADS": "1",
    "LANG": "C.UTF-8",
}
"""Environment variables for every Python process that a workspace's sandbox runs."""


@dataclass(frozen=True)
class Mount:
    """A folder or file of the machine that is visible in the sandbox, at the same path unless `source` is given.

    At the isolation level `process`, nothing is mounted, so code finds what the machine has at `path`.
    """

    path: Path
    writable: bool = False
    source: Path | None = None  # the folder or file that is mounted at `path`, if it is another one


@dataclass(frozen=True)
class View:
    """The part of the machine that a worker sandbox sees, besides the system, the grader and its scratch folder."""

    shown: tuple[Path, ...] = ()  # folders and files that it can only read
    # The submission. Root's worker gets a copy, because the worker runs as another user, who may be unable to read it.
    submitted: tuple[Path, ...] = ()
    writable: tuple[Path, ...] = ()  # folders that it can write to
    copies: Mapping[Path, Path] = field(default_factory=dict)  # by path: the copy that is mounted there instead


@dataclass(frozen=True)
class Sandbox:
    """One sandbox: visible files, resource limits and environment."""

    workdir: Path  # the working folder, inside a mount
    # What is visible besides the read-only system and the grader's Python. Suites and solutions in mounts are hidden.
    mounts: tuple[Mount, ...] = ()
    # All environment variables of the code. It inherits none.
    environment: Mapping[str, str] = field(default_factory=dict)
    network: bool = False  # whether it can use the worker sandbox's loopback interface, to reach the grader over DDS
    limits: Limits = NODE  # the resource limits of the tree
