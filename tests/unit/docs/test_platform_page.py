"""The platform page lists the versions that the lock installs, and a reason for each that differs."""

from __future__ import annotations

import runpy
import subprocess
import sys

import pytest

from autograder.course_paths import ROOT
from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.ros2.main import STANDINS_FOLDER

SCRIPT = runpy.run_path(str(ROOT / "docs" / "platform_page.py"))
LOCK, locked = SCRIPT["LOCK"], SCRIPT["locked"]
LOCKED = """numpy==1.26.4 ; python_full_version < '3.13' \\
    --hash=sha256:00
numpy==2.1.3 ; python_full_version == '3.13.*' and sys_platform == 'linux' \\
    --hash=sha256:01
pytest==7.4.4
"""


def test_a_lock_is_read_for_each_python() -> None:
    assert locked(LOCKED, "3.12") == {"numpy": "1.26.4", "pytest": "7.4.4"}
    assert locked(LOCKED, "3.13") == {"numpy": "2.1.3", "pytest": "7.4.4"}


def test_the_platform_page_lists_what_the_lock_installs_and_which_tutorials_run() -> None:
    page = SCRIPT["current"]()
    installed = locked(LOCK.read_text(encoding="utf-8"), DISTRIBUTION.pythons[0])
    assert all(
        f"| {package.name} | {package.debian} | {package.version} |" in page for package in DISTRIBUTION.packages
    )
    assert all(installed[package.name] in page for package in DISTRIBUTION.packages)
    assert "| yes | `publisher_and_subscriber` |" in page


@pytest.mark.promise(
    "pytest, setuptools, CMake and similar tools have the versions of Ubuntu 24.04",
    "Students' programs, builds and tests use the versions of that platform",
)
@pytest.mark.parametrize("python", SCRIPT["PYTHONS"])
def test_the_lock_installs_the_platforms_versions_or_the_page_gives_the_reason(python: str) -> None:
    versions = locked(LOCK.read_text(encoding="utf-8"), python)
    unexplained = {
        package.name: versions[package.name]
        for package in DISTRIBUTION.packages
        if versions[package.name] != package.version and not (package.differs and python == "3.13")
    }
    assert unexplained == {}


@pytest.mark.promise("Features that are not covered raise an error that says so.")
@pytest.mark.parametrize("name", SCRIPT["LAUNCH"])
def test_each_name_listed_as_not_covered_raises_an_error_that_says_so(name: str) -> None:
    module, _, attribute = name.rpartition(".")
    program = f"import sys; sys.path.insert(0, {str(STANDINS_FOLDER)!r})\nfrom {module} import {attribute}"
    completed = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert f"'{name}' is not covered: this is the course's stand-in" in completed.stderr
