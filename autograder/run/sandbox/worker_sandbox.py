"""A worker sandbox: a trusted worker process in its own namespaces, with a scratch folder that is removed with it."""

from __future__ import annotations

import fcntl
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

from autograder import course_paths
from autograder.ros.environment import without_wheel_bootstrap
from autograder.run.sandbox import bubblewrap, cgroup, warm_caches
from autograder.run.sandbox.identity import ordinary_user
from autograder.run.sandbox.isolation import Isolation, gives_up_root, require
from autograder.run.sandbox.launcher import ISOLATION_VARIABLE
from autograder.run.sandbox.limits import GRADING_WORKER, Limits, TreeLimits
from autograder.run.sandbox.process import ExitReason, Process
from autograder.run.sandbox.spec import View
from autograder.run.sandbox.trees import copy_unread
from autograder.submission.intake.files import MAX_DEPTH, MAX_READ_BYTES, MAX_SCANNED
from autograder.submission.intake.ignored import environment_parts, is_ignored

NOTHING = View()
# One more of each than intake takes, so that it refuses a copy as it refuses the original.
_SUBMITTED = TreeLimits(names=MAX_SCANNED + 2, size=MAX_READ_BYTES, depth=MAX_DEPTH + 2)
_PREFIX = "autograder-worker-"
_PASSED = (
    *("PATH", "LANG", "LC_", "TZ", "PYTHON", "LD_LIBRARY_PATH", "COVERAGE_", "AUTOGRADER_"),
    *("AMENT_", "CMAKE_PREFIX_PATH", "COLCON_", "FASTDDS_", "FASTRTPS_", "RCUTILS_", "RMW_", "ROS_"),
)
_YOUNG = 60.0  # s in which a folder that was just made gets its lock


@dataclass(frozen=True)
class WorkerReport:
    """The exit reason of a worker, its output on stdout and stderr, and the files that it left."""

    exit_reason: ExitReason
    returncode: int
    output: str
    files: Mapping[str, bytes] = field(default_factory=dict)


def run_in_worker_sandbox(
    make_command: Callable[[Path], list[str]],
    isolation: Isolation,
    limits: Limits = GRADING_WORKER,
    *,
    view: View = NOTHING,
) -> WorkerReport:
    """Run a trusted command in a new worker sandbox until it ends. Arguments and errors: see `in_worker_sandbox`."""
    with in_worker_sandbox(make_command, isolation, limits, view=view) as (process, _):
        return ended(process)


def ended(process: Process) -> WorkerReport:
    """Wait for a process to end, and report it."""
    process.wait(None)
    assert process.exit_reason is not None
    return WorkerReport(process.exit_reason, process.returncode or 0, process.output)


@contextmanager
def in_worker_sandbox(
    make_command: Callable[[Path], list[str]],
    isolation: Isolation,
    limits: Limits = GRADING_WORKER,
    *,
    view: View = NOTHING,
    pass_fds: tuple[int, ...] = (),
) -> Iterator[tuple[Process, Path]]:
    """Start a trusted command in a new worker sandbox, and yield its process and its scratch folder. Both end with it.

    Args:
        make_command: gets the worker sandbox's scratch folder, returns the command.
        isolation: the isolation level. An IsolationError says why this machine does not support it.
        limits: a bound on the whole worker sandbox, students' processes included.
        view: the parts of the machine that it sees, at the isolation level `bubblewrap`.
        pass_fds: descriptors that the command inherits.
    """
    require(isolation)
    _sweep()
    if isolation is Isolation.BUBBLEWRAP:
        warm_caches.compile_grader()
    scratch = Path(tempfile.mkdtemp(prefix=_PREFIX))
    held = os.open(scratch, os.O_RDONLY)
    fcntl.flock(held, fcntl.LOCK_EX)  # the kernel lets go of it when this process is killed
    try:
        command = make_command(scratch)
        with ExitStack() as stack:
            group, environment = None, {**without_wheel_bootstrap(os.environ), **_own(scratch, isolation)}
            if isolation is Isolation.BUBBLEWRAP:
                user = stack.enter_context(ordinary_user())
                group = cgroup.make_nested(limits, user)
                view = view if user is None else _reachable(view, scratch, user)
                command = group.enter(
                    bubblewrap.worker_sandbox(command, view, scratch=scratch, user=user, groups=group.folders)
                )
                environment = {
                    **passed_variables(environment),
                    **_own(scratch, isolation),
                    "HOME": "/tmp",
                    "TMPDIR": "/tmp",
                    "ROS_LOG_DIR": "/tmp/ros-log",  # the grader's nodes log although a program has filled `scratch`
                }
            elif gives_up_root(isolation):
                user = stack.enter_context(ordinary_user())
                assert user is not None
                for path in view.submitted:
                    place = place_of(path, isolation, scratch)
                    place.parent.mkdir(exist_ok=True)
                    copy_submission(path, place)
                for folder in (scratch, *view.writable):
                    os.chown(folder, user, user)
                command = [*bubblewrap.becoming(user), *command]
                environment = {**passed_variables(environment), **_own(scratch, isolation), "HOME": str(scratch)}
            # `python -m` imports from the folder it is started in, and that may hold submissions.
            place = Path("/")
            process = Process(command, limits, environment=environment, pass_fds=pass_fds, group=group, cwd=place)
            stack.enter_context(process)
            yield process, scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        os.close(held)


def place_of(path: Path, isolation: Isolation, scratch: Path) -> Path:
    """Return where the command of a worker sandbox finds the submission: at its path, or as a readable copy."""
    return scratch / "submitted" / path.name if gives_up_root(isolation) else path


def _reachable(view: View, scratch: Path, user: int) -> View:
    """Return a view in which a user can read the submission and write to the writable folders."""
    copies = {path: scratch / "submitted" / f"{number}" for number, path in enumerate(view.submitted)}
    for path, copy in copies.items():
        copy.parent.mkdir(exist_ok=True)
        copy_submission(path, copy)
    for folder in view.writable:
        os.chown(folder, user, user)
    return replace(view, copies=copies)


def copy_submission(path: Path, copy: Path) -> None:
    """Copy a submission so that intake reads it like the original."""
    copy_unread(path, copy, _SUBMITTED, lambda names: {*filter(is_ignored, names), *environment_parts(names)})


def _own(scratch: Path, isolation: Isolation) -> dict[str, str]:
    folders = [
        str(course_paths.ROOT),
        os.environ.get("PYTHONPATH", ""),
    ]  # this grader, from whatever folder it was started
    path = (
        {} if course_paths.ROOT.is_relative_to(sys.prefix) else {"PYTHONPATH": os.pathsep.join(filter(None, folders))}
    )
    return {ISOLATION_VARIABLE: isolation.value, "ROS_LOG_DIR": str(scratch / "ros-log"), **path}


def passed_variables(environment: Mapping[str, str]) -> dict[str, str]:
    """Return the variables for a worker sandbox, without others of the shell, which may contain secrets."""
    return {name: value for name, value in environment.items() if name.startswith(_PASSED)}


def _sweep() -> None:
    """Remove the folders of worker sandboxes whose grader was killed: their locks are free."""
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
