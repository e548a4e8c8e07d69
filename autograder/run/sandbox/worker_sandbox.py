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
from autograder.run.sandbox.trees import copy_untrusted
from autograder.submission.intake.files import MAX_DEPTH, MAX_READ_BYTES, MAX_SCANNED
from autograder.submission.intake.ignored import environment_parts, is_ignored

EMPTY_VIEW = View()
# The limits exceed what intake accepts, so that intake refuses the copy of a submission if it refuses the original.
_COPY_LIMITS = TreeLimits(names=MAX_SCANNED + 2, size=MAX_READ_BYTES, depth=MAX_DEPTH + 2)
_PREFIX = "autograder-worker-"
_PASSED_PREFIXES = (
    *("PATH", "LANG", "LC_", "TZ", "PYTHON", "LD_LIBRARY_PATH", "COVERAGE_", "AUTOGRADER_"),
    *("AMENT_", "CMAKE_PREFIX_PATH", "COLCON_", "FASTDDS_", "FASTRTPS_", "RCUTILS_", "RMW_", "ROS_"),
)
_MIN_AGE = 60.0  # s; a younger folder may not have its lock yet


@dataclass(frozen=True)
class WorkerReport:
    """The exit reason of a worker, its output on stdout and stderr, and its output files."""

    exit_reason: ExitReason
    returncode: int
    output: str
    files: Mapping[str, bytes] = field(default_factory=dict)


def run_in_worker_sandbox(
    make_command: Callable[[Path], list[str]],
    isolation: Isolation,
    limits: Limits = GRADING_WORKER,
    *,
    view: View = EMPTY_VIEW,
) -> WorkerReport:
    """Run a trusted command in a new worker sandbox until it ends. `in_worker_sandbox` explains the arguments."""
    with in_worker_sandbox(make_command, isolation, limits, view=view) as (process, _):
        return wait_and_report(process)


def wait_and_report(process: Process) -> WorkerReport:
    """Wait until a process has ended, and return its report."""
    process.wait(None)
    assert process.exit_reason is not None
    return WorkerReport(process.exit_reason, process.returncode or 0, process.output)


@contextmanager
def in_worker_sandbox(
    make_command: Callable[[Path], list[str]],
    isolation: Isolation,
    limits: Limits = GRADING_WORKER,
    *,
    view: View = EMPTY_VIEW,
    pass_fds: tuple[int, ...] = (),
) -> Iterator[tuple[Process, Path]]:
    """Start a trusted command in a new worker sandbox, and yield its process and its scratch folder.

    Args:
        make_command: returns the command. It is called with the scratch folder of the worker sandbox.
        isolation: the isolation level. If this machine does not support it, an IsolationError gives the reason.
        limits: the limits of the whole worker sandbox, including students' processes.
        view: the parts of the machine that the command sees at the isolation level `bubblewrap`.
        pass_fds: descriptors that the command inherits.
    """
    require(isolation)
    _remove_stale_folders()
    if isolation is Isolation.BUBBLEWRAP:
        warm_caches.compile_grader()
    scratch = Path(tempfile.mkdtemp(prefix=_PREFIX))
    lock = os.open(scratch, os.O_RDONLY)
    fcntl.flock(lock, fcntl.LOCK_EX)  # the kernel releases it when this process ends
    try:
        command = make_command(scratch)
        with ExitStack() as stack:
            group, environment = None, {**without_wheel_bootstrap(os.environ), **_own_variables(scratch, isolation)}
            if isolation is Isolation.BUBBLEWRAP:
                user = stack.enter_context(ordinary_user())
                group = cgroup.make_nested(limits, user)
                view = view if user is None else _make_accessible(view, scratch, user)
                command = group.enter(
                    bubblewrap.worker_sandbox(command, view, scratch=scratch, user=user, groups=group.folders)
                )
                environment = {
                    **passed_variables(environment),
                    **_own_variables(scratch, isolation),
                    "HOME": "/tmp",
                    "TMPDIR": "/tmp",
                    "ROS_LOG_DIR": "/tmp/ros-log",  # where the grader's nodes can log even if `scratch` is full
                }
            elif gives_up_root(isolation):
                user = stack.enter_context(ordinary_user())
                assert user is not None
                for path in view.submitted:
                    place = path_in_sandbox(path, isolation, scratch)
                    place.parent.mkdir(exist_ok=True)
                    copy_submission(path, place)
                for folder in (scratch, *view.writable):
                    os.chown(folder, user, user)
                command = [*bubblewrap.setpriv_command(user), *command]
                environment = {
                    **passed_variables(environment),
                    **_own_variables(scratch, isolation),
                    "HOME": str(scratch),
                }
            # `python -m` imports from its working folder, which may contain submissions.
            place = Path("/")
            process = Process(command, limits, environment=environment, pass_fds=pass_fds, group=group, cwd=place)
            stack.enter_context(process)
            yield process, scratch
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        os.close(lock)


def path_in_sandbox(path: Path, isolation: Isolation, scratch: Path) -> Path:
    """Return where the command of a worker sandbox finds the submission: at its own path, or at that of a copy."""
    return scratch / "submitted" / path.name if gives_up_root(isolation) else path


def _make_accessible(view: View, scratch: Path, user: int) -> View:
    """Return the view with a copy of the submission. The user becomes the owner of the writable folders."""
    copies = {path: scratch / "submitted" / f"{number}" for number, path in enumerate(view.submitted)}
    for path, copy in copies.items():
        copy.parent.mkdir(exist_ok=True)
        copy_submission(path, copy)
    for folder in view.writable:
        os.chown(folder, user, user)
    return replace(view, copies=copies)


def copy_submission(path: Path, copy: Path) -> None:
    """Copy a submission so that intake reads it like the original."""
    copy_untrusted(path, copy, _COPY_LIMITS, lambda names: {*filter(is_ignored, names), *environment_parts(names)})


def _own_variables(scratch: Path, isolation: Isolation) -> dict[str, str]:
    folders = [
        str(course_paths.ROOT),
        os.environ.get("PYTHONPATH", ""),
    ]  # so that the worker imports this grader, whatever its working folder is
    path = (
        {} if course_paths.ROOT.is_relative_to(sys.prefix) else {"PYTHONPATH": os.pathsep.join(filter(None, folders))}
    )
    return {ISOLATION_VARIABLE: isolation.value, "ROS_LOG_DIR": str(scratch / "ros-log"), **path}


def passed_variables(environment: Mapping[str, str]) -> dict[str, str]:
    """Return the variables that a worker sandbox gets. The others may contain secrets."""
    return {name: value for name, value in environment.items() if name.startswith(_PASSED_PREFIXES)}


def _remove_stale_folders() -> None:
    """Remove the folders of worker sandboxes whose grader was killed, so that nothing holds their locks."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
        with suppress(OSError):
            if folder.stat().st_uid != os.geteuid() or time.time() - folder.stat().st_mtime < _MIN_AGE:
                continue
            lock = os.open(folder, os.O_RDONLY | os.O_NOFOLLOW | os.O_DIRECTORY)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder, ignore_errors=True)
            finally:
                os.close(lock)
