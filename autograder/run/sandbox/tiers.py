"""The tiers of isolation, and which of them this machine can give."""

from __future__ import annotations

import shutil
import subprocess
from enum import Enum
from functools import cache
from pathlib import Path

from autograder.exceptions import IsolationError
from autograder.run.sandbox import bubblewrap
from autograder.run.sandbox.identity import ordinary_user
from autograder.run.sandbox.spec import Sandbox, View


class Tier(str, Enum):
    """How well students' code is kept apart; the name stands in every result.

    `bubblewrap`: own process, mount, ipc, user and network namespaces.
    `process`: only a process tree with limits. Students' code can read what the grader's user can read.
    """

    BUBBLEWRAP = "bubblewrap"
    PROCESS = "process"


@cache
def best_tier() -> Tier:
    """Return the strongest tier of this machine; tried for real, a sandbox inside a cell."""
    return Tier.BUBBLEWRAP if namespaces_failure() is None else Tier.PROCESS


@cache
def namespaces_failure() -> str | None:
    """Return why a sandbox inside a cell cannot be made here, or None where it can."""
    if shutil.which("bwrap") is None:
        return "bubblewrap is not installed"
    inner = bubblewrap.sandbox(["true"], Sandbox(Path("/tmp")), filter_fd=None)
    with ordinary_user() as user:
        outer = bubblewrap.cell(inner, View(), scratch=Path("/tmp/cell"), user=user)
        try:
            done = subprocess.run(outer, capture_output=True, text=True, timeout=20, check=False)
        except subprocess.TimeoutExpired:
            return "bubblewrap did not answer within 20 s"
    return None if done.returncode == 0 else done.stderr.strip() or f"bwrap ended with status {done.returncode}"


def require(tier: Tier) -> Tier:
    """Return `tier` if this machine can give it, or raise an IsolationError that says why not and how to fix it."""
    failure = namespaces_failure() if tier is Tier.BUBBLEWRAP else None
    if failure is not None:
        raise IsolationError(
            f"this machine cannot isolate submissions: {failure}. `autograder doctor` says how to fix it; "
            "`--isolation process` grades with the weaker tier, for code that you trust"
        )
    return tier
