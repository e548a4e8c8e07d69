"""The programs and parameters that are given with the package; the checks launch them as they were given.

A check tests what a launch file does. A changed reporter that restarts itself could do this instead.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import cache

from autograder.checking import Workspace, solution_path
from autograder.checking.probes import given_files, student_test_runs, versions
from autograder.checks.ch04_launch.support.contract import CONFIG, PACKAGE

NAMES = ("driver", "reporter", "self_test")
_REFERENCE = solution_path(PACKAGE)


@cache
def given_programs() -> Mapping[str, str]:
    """Return the text of each executable by its name: the given module, which imports nothing from the package."""
    return {
        name: f"#!{sys.executable}\n{(_REFERENCE / PACKAGE / f'{name}.py').read_text(encoding='utf-8')}"
        for name in NAMES
    }


def given_parameters() -> str:
    """Return the text of the given parameters file."""
    return (_REFERENCE / CONFIG).read_text(encoding="utf-8")


def changed_files(workspace: Workspace) -> list[str]:
    """Return the paths of the given modules and parameters that are missing or were changed."""
    return given_files.changed_files(
        student_test_runs.read_source(workspace, PACKAGE).files, versions.read_files(_REFERENCE), (PACKAGE, "config")
    )
