"""Chooses the long tests, and their cases, that run for this commit. The runs of several commits take all of them.

The environment variable `DRAW=all` takes all of them. The workflow sets it: its jobs have a machine each.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
# Files of long tests. Those of a row take about the same time, and the commit draws one of them.
ROWS = (
    (
        "tests/e2e/test_nbgrader.py",
        "tests/e2e/test_attacks.py",
        "tests/e2e/test_grading.py",
        "tests/browser/test_site.py",
        "tests/e2e/test_cluster.py",
        "tests/e2e/ros2_records/test_records.py",
    ),
    (
        "tests/browser/test_formgrader.py",
        "tests/e2e/test_lockstep_features.py",
        "tests/e2e/test_new_chapter.py",
        "tests/e2e/test_notebook_api.py",
        "tests/e2e/test_second_course.py",
        "tests/e2e/test_solutions.py",
    ),
    (
        "tests/browser/test_live_view.py",
        "tests/browser/test_students_lab.py",
        "tests/e2e/test_cmake_overlay.py",
        "tests/e2e/test_colcon_host.py",
        "tests/e2e/test_lockstep_or_real.py",
        "tests/notebooks/test_student_answers.py",
        "tests/browser/test_solve_in_jupyterlab.py",
        "tests/e2e/test_build_outcomes.py",
        "tests/e2e/test_created_packages.py",
        "tests/e2e/test_gradescope.py",
        "tests/e2e/test_hostile_class.py",
        "tests/e2e/test_interface_bundle.py",
    ),
    (
        "tests/e2e/launch_cases/test_cases.py",
        "tests/e2e/launch_standin/test_launch_files.py",
        "tests/e2e/launch_standin/test_launch_harness.py",
        "tests/e2e/test_bad_input.py",
        "tests/e2e/test_interfaces.py",
        "tests/e2e/test_worker_pool.py",
    ),
    ("tests/e2e/test_bridge.py", "tests/e2e/test_ros2_command.py", "tests/notebooks/test_two_robots.py"),
    ("tests/e2e/test_notebook_parameters.py", "tests/e2e/test_ros2_lifecycle.py", "tests/e2e/test_ros2_pkg_create.py"),
    ("tests/browser/test_feedback.py", "tests/browser/test_run_page.py", "tests/e2e/test_lms.py"),
)


@lru_cache(maxsize=1)
def commit() -> str:
    """Return the hash of the commit that is checked out, "" outside of a repository."""
    found = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False)
    return found.stdout.strip()


def sample(names: Iterable[str], one_in: int, draw: str | None = None) -> set[str]:
    """Return one in so many names, at least one, as a draw chooses them.

    Every draw chooses the same number, so that all runs take equally long.

    Args:
        names: what is drawn from.
        one_in: in how many there is a chosen one.
        draw: the draw; that of the environment, or the commit, if there is none.
    """
    text = os.environ.get("DRAW", commit()) if draw is None else draw
    if text == "all":
        return set(names)
    ranked = sorted(names, key=lambda name: hashlib.sha256(f"{text} {name}".encode()).digest())
    return set(ranked[: -(-len(ranked) // one_in)])


def files_left_out(draw: str | None = None) -> set[str]:
    """Return the files of `ROWS` that a draw leaves for the night; the argument is as in `sample`."""
    return {file for row in ROWS for file in set(row) - sample(row, len(row), draw)}


def unless(chosen: bool) -> list[pytest.MarkDecorator]:
    """Return the marks of a case: one that is not chosen runs at night."""
    return [] if chosen else [pytest.mark.nightly]
