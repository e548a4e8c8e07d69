"""The programs and the parameters that came with the package: a launch runs them as they were given.

A launch file is judged by what it starts. A reporter that starts itself again would do what the launch file should.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import cache

from autograder import layout
from autograder.checks.ch04_launch.support.contract import CONFIG, PACKAGE
from autograder.harness import Workspace
from autograder.probes import student_test_runs
from autograder.probes.given_files import changed_files
from autograder.probes.versions import read_files

NAMES = ("driver", "reporter", "self_test")
_HOME = layout.SOLUTIONS / PACKAGE


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
    return changed_files(student_test_runs.take(workspace, PACKAGE).files, read_files(_HOME), (PACKAGE, "config"))
