"""The isolation levels, and tests of which of them this machine supports."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from enum import Enum
from functools import cache
from pathlib import Path

from autograder import course_paths
from autograder.exceptions import IsolationError
from autograder.run.sandbox import bubblewrap
from autograder.run.sandbox.identity import ordinary_user
from autograder.run.sandbox.spec import Sandbox, View

_TRIAL_ENVIRONMENT = {"PATH": os.defpath, "PYTHONPATH": str(course_paths.ROOT), "PYTHONDONTWRITEBYTECODE": "1"}


class Isolation(str, Enum):
    """How strongly students' code is isolated. Every result contains the name of the level.

    `bubblewrap`: separate process, mount, ipc, user and network namespaces.
    `process`: only a process tree with limits. Students' code can read everything that the grader's user can read.
    """

    BUBBLEWRAP = "bubblewrap"
    PROCESS = "process"


@cache
def best_isolation() -> Isolation:
    """Return the strongest isolation level that this machine supports. This starts nested sandboxes as a trial."""
    return Isolation.BUBBLEWRAP if namespaces_failure() is None else Isolation.PROCESS


@cache
def namespaces_failure() -> str | None:
    """Return why this machine cannot start a sandbox inside a worker sandbox, or None if it can."""
    if shutil.which("bwrap") is None:
        return "bubblewrap is not installed"
    inner = bubblewrap.sandbox(["true"], Sandbox(Path("/tmp")), filter_fd=None)
    with ordinary_user() as user:
        outer = bubblewrap.worker_sandbox(inner, View(), scratch=Path("/tmp/worker"), user=user)
        try:
            completed = subprocess.run(outer, capture_output=True, text=True, timeout=20, check=False)
        except subprocess.TimeoutExpired:
            return "bubblewrap did not answer within 20 s"
    return (
        None
        if completed.returncode == 0
        else completed.stderr.strip() or f"bwrap ended with status {completed.returncode}"
    )


def gives_up_root(isolation: Isolation) -> bool:
    """Return whether worker sandboxes of this process run as another user, without namespaces."""
    return isolation is Isolation.PROCESS and os.geteuid() == 0


@cache
def _root_failure(temporary: str) -> str | None:
    """Return why root's worker sandboxes cannot run as other users with folders in `temporary`, or None if they can."""
    if shutil.which("setpriv") is None:
        return "setpriv is not installed"
    with ordinary_user() as user:
        assert user is not None
        trial = [sys.executable, "-c", "import os, sys, autograder.grade; os.chdir(sys.argv[1])", temporary]
        command = [*bubblewrap.setpriv_command(user), *trial]
        completed = subprocess.run(
            command, capture_output=True, text=True, timeout=60, check=False, cwd="/", env=_TRIAL_ENVIRONMENT
        )
    return None if completed.returncode == 0 else (completed.stderr.strip().splitlines() or ["setpriv failed"])[-1]


def require(isolation: Isolation) -> Isolation:
    """Return `isolation` if this machine supports it. Otherwise raise an IsolationError with the reason and a fix."""
    temporary = tempfile.gettempdir()
    if gives_up_root(isolation) and (reason := _root_failure(temporary)) is not None:
        raise IsolationError(
            f"with `--isolation process` root's gradings run as an ordinary user, which fails here: {reason}. Let "
            f"others read the grader (`chmod -R go+rX {course_paths.ROOT}`) and enter {temporary}, "
            "or start it as an ordinary user"
        )
    failure = namespaces_failure() if isolation is Isolation.BUBBLEWRAP else None
    if failure is not None:
        raise IsolationError(
            f"this machine cannot isolate submissions: {failure}. `autograder doctor` says how to fix it; "
            "`--isolation process` grades with the weaker isolation level, for code that you trust"
        )
    return isolation
