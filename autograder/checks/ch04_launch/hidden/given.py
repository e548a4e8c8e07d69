"""The programs and the parameters that came with the package: a launch runs them as they were given.

A launch file is judged by what it starts. A reporter that starts itself again would do what the launch file should.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import cache

from autograder.checking import Workspace, solution_path
from autograder.checking.probes import given_files, student_test_runs, versions
from autograder.checks.ch04_launch.support.contract import CONFIG, PACKAGE

NAMES = ("driver", "reporter", "self_test")
_HOME = solution_path(PACKAGE)


@cache
def given_programs() -> Mapping[str, str]:
    """Return the text of each executable, by its name: the given module, which imports nothing of the package."""
    return {
        name: f"#!{sys.executable}\n{(_HOME / PACKAGE / f'{name}.py').read_text(encoding='utf-8')}" for name in NAMES
    }


def given_parameters() -> str:
    """Return the text of the given parameters file."""
    return (_HOME / CONFIG).read_text(encoding="utf-8")


def changed(workspace: Workspace) -> list[str]:
    """Return the paths of the modules and parameters that are missing or not as they were given."""
    return given_files.changed_files(
        student_test_runs.read_source(workspace, PACKAGE).files, versions.read_files(_HOME), (PACKAGE, "config")
    )
