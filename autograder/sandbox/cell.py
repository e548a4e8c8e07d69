"""A cell: a trusted worker process in namespaces of its own, with a scratch folder that dies with it."""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from autograder.ros.environment import without_wheel_bootstrap
from autograder.sandbox import bubblewrap
from autograder.sandbox.launcher import TIER_VARIABLE
from autograder.sandbox.limits import CELL_SCRATCH, GRADING_CELL, Limits
from autograder.sandbox.process import Ending, Process
from autograder.sandbox.tiers import Tier, require

_PREFIX = "autograder-cell-"
_YOUNG = 60.0  # s in which a folder that was just made gets its lock


@dataclass(frozen=True)
class CellReport:
    """How a worker ended, and what it wrote to stdout and stderr."""

    ending: Ending
    returncode: int
    output: str


def run_in_cell(make_command: Callable[[Path], list[str]], tier: Tier, limits: Limits = GRADING_CELL) -> CellReport:
    """Run a trusted command in a new cell and wait for its end; arguments and errors are those of `in_cell`."""
    with in_cell(make_command, tier, limits) as (process, _):
        process.wait(None)
        assert process.ending is not None
        return CellReport(process.ending, process.returncode or 0, process.output)


@contextmanager
def in_cell(
    make_command: Callable[[Path], list[str]],
    tier: Tier,
    limits: Limits = GRADING_CELL,
    *,
    pass_fds: tuple[int, ...] = (),
) -> Iterator[tuple[Process, Path]]:
    """Start a trusted command in a new cell; give its process and the cell's scratch folder, which both end with it.

    Args:
        make_command: gets the cell's scratch folder, returns the command.
        tier: how strongly the cell is kept apart; an IsolationError where this machine cannot give it.
        limits: a bound on the whole cell, students' processes included.
        pass_fds: descriptors that the command inherits.
    """
    require(tier)
    _sweep()
    scratch = Path(tempfile.mkdtemp(prefix=_PREFIX))
    held = os.open(scratch, os.O_RDONLY)
    fcntl.flock(held, fcntl.LOCK_EX)  # the kernel lets go of it when this process is killed
    try:
        command = make_command(scratch)
        if tier is Tier.BUBBLEWRAP:
            command = bubblewrap.cell(command, scratch=scratch, size=CELL_SCRATCH)
        own = {TIER_VARIABLE: tier.value, "ROS_LOG_DIR": str(scratch / "ros-log")}
        environment = {**without_wheel_bootstrap(os.environ), **own}
        # `python -m` imports from the folder it is started in, and that may hold submissions.
        with Process(command, limits, environment=environment, pass_fds=pass_fds, cwd=Path("/")) as process:
            yield process, scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        os.close(held)


def _sweep() -> None:
    """Remove cells' folders whose grader was killed: nobody holds their lock."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
        with suppress(OSError):
            if folder.stat().st_uid != os.geteuid() or time.time() - folder.stat().st_mtime < _YOUNG:
                continue
            held = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW | os.O_DIRECTORY)
            try:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder, ignore_errors=True)
            finally:
                os.close(held)
