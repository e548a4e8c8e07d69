"""`autograder check --watch`: checks a workspace again when a file is saved, until Ctrl-C.

Files are polled a few times a second. They are checked once they have not changed for a moment, so that no file is read
while it is being written. If that happens anyway, the files are checked again afterwards.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from autograder import course_paths
from autograder.exceptions import GraderError, UsageError
from autograder.notebook.checking import Part, run_part
from autograder.notebook.notices import Notice
from autograder.notebook.stored_results import stamp_of
from autograder.suite import Outcome, fingerprint

POLL_SECONDS = 0.25  # the time between two looks at the files
QUIET_SECONDS = 0.5  # files that have not changed for this long count as saved
WAITING = "Waiting for a file to be saved. Ctrl-C ends this."

Show = Callable[[object], None]


def watch(part: Part, workspace: Path, show: Show, *, pause: Callable[[float], None] = time.sleep) -> None:
    """Check a workspace now, and again whenever a file of the workspace or the chapter changes, until Ctrl-C.

    Args:
        part: the part to check.
        workspace: a colcon workspace.
        show: a function that is called with each report and each progress message.
        pause: a function that waits for the given number of seconds.

    Raises:
        UsageError: the workspace does not exist.
    """
    source = workspace / "src"
    if not source.is_dir():
        raise UsageError(f"the folder {source} does not exist: run this from the assignment's folder, where ws/src is")
    failed_checks: tuple[str, ...] = ()
    try:
        while True:
            checked_stamp = _stamp(part.assignment, workspace)
            try:
                report = run_part(part, workspace, first=failed_checks, early=show)
                failed_checks = tuple(line.id for line in report.lines if line.outcome is Outcome.FAILED)
                show(report)
            except (GraderError, UsageError, OSError) as error:  # for example, a file was deleted while it was copied
                show(Notice(str(error)))
            if _stamp(part.assignment, workspace) == checked_stamp:
                show(Notice(WAITING))
            _wait(part.assignment, workspace, checked_stamp, pause)
    except KeyboardInterrupt:
        return


def _wait(assignment: str, workspace: Path, checked_stamp: str, pause: Callable[[float], None]) -> None:
    """Wait until the files have changed since `checked_stamp` and have then stayed the same for a moment."""
    latest_stamp, changed_at = checked_stamp, time.monotonic()
    while latest_stamp == checked_stamp or time.monotonic() - changed_at < QUIET_SECONDS:
        pause(POLL_SECONDS)
        if (current_stamp := _stamp(assignment, workspace)) != latest_stamp:
            latest_stamp, changed_at = current_stamp, time.monotonic()


def _stamp(assignment: str, workspace: Path) -> str:
    """Return a digest of when the files that a student or an author edits were last saved."""
    checks = fingerprint.suite_paths(assignment, parts=("visible",))
    return stamp_of((workspace / "src", course_paths.source_notebook(assignment), *checks))
