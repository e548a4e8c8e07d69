"""Integration tests that use `launch_pytest`, run by pytest as by a student."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.ros import environment

OWN_NETWORK = ("unshare", "-rn", "sh", "-c", 'ip link set lo up && exec "$@"', "sh")
SAMPLES = Path(__file__).parent / "samples/sample_launch_tests.py"
PASSED = {
    "test_plain",
    "test_coroutine",
    "test_generator",
    "test_async_generator",
    "test_of_an_exit",
    "test_of_an_exit_in_plain_python",
    "test_first_of_all",
    "test_second_of_all",
    "test_after_the_end_of_all",
    "test_of_a_launch_that_ends_by_itself",
    "test_without_a_launch",
}


def run_pytest(folder: Path, fleet: Path, file: Path) -> str:
    variables = environment.find().variables(overlays=(fleet,), log_dir=folder / "log")
    command = [sys.executable, "-m", "pytest", "-rA", "-W", "error", "-p", "no:cacheprovider", "--tb=short"]
    process = subprocess.run(
        [*OWN_NETWORK, *command, f"--rootdir={folder}", "-c", os.devnull, str(file)],
        env={**os.environ, **variables},
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=280,
        check=False,
    )
    return process.stdout


@pytest.fixture(scope="module")
def report(fleet: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The output of pytest for the samples."""
    folder = tmp_path_factory.mktemp("samples")
    file = folder / "test_samples.py"
    file.write_text(SAMPLES.read_text())
    return run_pytest(folder, fleet, file)


def test_tests_of_all_kinds_run_during_their_launch_and_after_its_end(report: str) -> None:
    assert set(re.findall(r"^PASSED \S+::(\w+)", report, re.MULTILINE)) == PASSED, report


def test_a_test_can_fail_during_its_launch_and_after_its_end(report: str) -> None:
    failed = set(re.findall(r"^FAILED \S+::(\w+) - ", report, re.MULTILINE))
    assert failed == {"test_that_fails_during_the_launch", "test_that_fails_after_the_end"}, report
    assert "AssertionError: assert 'something else' in " in report
    assert "assert 0 == 5" in report


def test_a_launch_that_fails_is_an_error_of_its_fixture(report: str) -> None:
    errors = set(re.findall(r"^ERROR \S+::(\w+) - ", report, re.MULTILINE))
    assert errors == {
        "test_of_a_launch_that_fails",
        "test_of_a_fixture_that_returns_something_else",
        "test_of_a_launch_that_is_ready_twice",
        "test_that_asks_for_a_launch_it_does_not_have",
    }, report
    for message in (
        "package 'no_such_package' not found",
        "the launch has failed before the test could begin: see its output",
        "When running launch_pytest fixture 'wrong': return value must be either a launch description",
        "containing only one ReadyToTest action",
        "this fixture is for tests that are marked with pytest.mark.launch(fixture=...)",
    ):
        assert message in report


def test_a_mark_without_a_fixture_is_refused(fleet: Path, tmp_path: Path) -> None:
    file = tmp_path / "test_mark.py"
    file.write_text("import pytest\n@pytest.mark.launch()\ndef test_it(): pass\n")
    output = run_pytest(tmp_path, fleet, file)
    assert '"fixture" keyword argument is required in a pytest.mark.launch() decorator' in output
