"""The autograder for Gradescope, run in the folders that Gradescope creates."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner

from autograder import course_paths
from autograder.author.verification.mutants import write_reference
from autograder.cli import group
from autograder.suite import suites

ASSIGNMENT = "01_package_structure"


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder `/autograder` of an image that Gradescope has built, with the packages of this environment."""
    home = tmp_path_factory.mktemp("autograder")
    completed = CliRunner().invoke(group, ["gradescope", ASSIGNMENT, "--out", str(home / "upload.zip")])
    assert completed.exit_code == 0, completed.output
    subprocess.run(["unzip", "-q", str(home / "upload.zip"), "-d", str(home / "source")], check=True)
    (home / "source" / "course" / ".venv").symlink_to(sys.prefix)
    return home


def grade(home: Path) -> dict[str, object]:
    """Run the autograder as Gradescope does; return its report."""
    script = home / "source" / "run_autograder"
    assert os.access(script, os.X_OK)
    subprocess.run([script], env={**os.environ, "GRADESCOPE_HOME": str(home)}, check=True, capture_output=True)
    report: dict[str, object] = json.loads((home / "results" / "results.json").read_text())
    return report


@pytest.mark.promise("Gradescope builds an image from it and grades each submission when it arrives.")
def test_the_reference_gets_full_marks_and_an_answer_without_packages_no_score(home: Path) -> None:
    submission = home / "submission"
    write_reference(suites.hidden(ASSIGNMENT).sources, submission / "ws")
    report = grade(home)
    assert report["score"] == suites.hidden(ASSIGNMENT).max_score
    assert {test["visibility"] for test in report["tests"]} == {"after_published"}  # type: ignore[attr-defined]

    for path in sorted(submission.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    (submission / "notes.txt").write_text("later")
    report = grade(home)
    assert "score" not in report
    assert "package" in str(report["output"])


@pytest.mark.promise("no submission gets a mark, and the output of each submission says why.")
def test_without_namespaces_a_submission_has_no_result_and_the_output_says_why(home: Path, tmp_path: Path) -> None:
    bwrap = tmp_path / "bwrap"
    bwrap.write_text("#!/bin/sh\necho 'No permissions to create new namespace' >&2\nexit 1\n")
    bwrap.chmod(0o755)
    (home / "submission").mkdir(exist_ok=True)
    (home / "results" / "results.json").unlink(missing_ok=True)
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    script = home / "source" / "run_autograder"
    completed = subprocess.run(
        [script], env={**os.environ, "GRADESCOPE_HOME": str(home), "PATH": path}, capture_output=True, text=True
    )
    assert completed.returncode == 1
    assert "cannot isolate submissions" in completed.stderr
    assert "No permissions to create new namespace" in completed.stderr
    assert not (home / "results" / "results.json").exists()


@pytest.mark.promise(
    "autograder gradescope 02_nodes --out 02_nodes.zip", "The zip contains `setup.sh`, `run_autograder`, and the course"
)
def test_the_zip_contains_everything_for_setup_and_no_build_products(home: Path) -> None:
    names = set(zipfile.ZipFile(home / "upload.zip").namelist())
    assert {"setup.sh", "run_autograder", "course/Makefile", "course/requirements.lock"} <= names
    assert not [name for name in names if "__pycache__" in name or name.startswith("course/tests")]
    script = (course_paths.ROOT / "assets" / "gradescope" / "setup.sh").read_text()
    assert "make setup" in script
    subprocess.run(["bash", "-n", str(home / "source" / "setup.sh")], check=True)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["00_welcome"], "there are no hidden checks for '00_welcome'; there are for: 01_package_structure"),
        ([ASSIGNMENT], "already exists: choose a new file name"),
    ],
    # A test whose id contains a chapter's name runs on another worker, which would set up the fixture again.
    ids=["no checks", "already exists"],
)
def test_invalid_arguments_of_the_gradescope_command_are_a_usage_error(
    home: Path, arguments: list[str], message: str
) -> None:
    completed = subprocess.run(
        [sys.executable, "-m", "autograder", "gradescope", *arguments, "--out", str(home / "upload.zip")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert completed.returncode == 2
    assert message in completed.stderr
