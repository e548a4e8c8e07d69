"""A clean end: Ctrl-C and a launch system's SIGTERM."""

from __future__ import annotations

import signal

from autograder.checks import group, hint
from autograder.checks.ch02_nodes.support.ending import HINTS, expect_clean_end
from autograder.harness import Workspace

check = group("lifecycle")


@check(points=2, holds="ends", depends=("publishes_cmd_vel",))
@hint(*HINTS)
def test_sigint(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, on Ctrl-C (SIGINT)."""
    expect_clean_end(workspace, signal.SIGINT)


@check(points=2, holds="ends", depends=("publishes_cmd_vel",))
@hint(*HINTS)
def test_sigterm(workspace: Workspace) -> None:
    """It ends with exit status 0, without a traceback, when a launch system stops it (SIGTERM)."""
    expect_clean_end(workspace, signal.SIGTERM)
