"""The two packages of 01_package_structure build without a warning of their own, and pass their own tests."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from autograder.layout import SOLUTIONS
from autograder.ros import environment

PACKAGES = ("square_dance", "wall_alarm")


@pytest.fixture(scope="module")
def tested(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A workspace in which both packages were built and tested, and what colcon said."""
    root = tmp_path_factory.mktemp("small")
    for package in PACKAGES:
        shutil.copytree(SOLUTIONS / package, root / "src" / package)
    ros = environment.find()
    variables = {**os.environ, **ros.variables(log_dir=root / "log/ros"), "PATH": environment.path_with_scripts()}
    said = ""
    for command in (["colcon", "build"], ["colcon", "test", "--return-code-on-test-failure"]):
        done = subprocess.run(command, cwd=root, env=variables, text=True, capture_output=True)
        said += done.stdout + done.stderr
        assert done.returncode == 0, said
    return root, said


@pytest.mark.parametrize("package", PACKAGES)
def test_a_small_packages_linters_and_tests_pass(tested: tuple[Path, str], package: str) -> None:
    report = ElementTree.parse(tested[0] / "build" / package / "pytest.xml")
    passed = {case.get("name", "") for case in report.iter("testcase") if len(case) == 0}
    assert {"test_copyright", "test_flake8", "test_pep257"} < passed


def test_colcon_has_nothing_to_say_against_them(tested: tuple[Path, str]) -> None:
    assert "Unknown distribution option" not in tested[1]
    assert "explicitly install" not in tested[1]
