"""The Makefile explains itself and picks an interpreter that runs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]


STUDENTS = ROOT / "assets" / "students" / "Makefile"


def make(*arguments: str, path: str | None = None, **environ: str) -> str:
    """Run make in the project, without the variables of a make around the tests, and return its output."""
    outer = ("MAKE", "MFLAGS", "PYTHON", "WORKERS", "PYTEST_ARGS")
    clean = {name: value for name, value in os.environ.items() if not name.startswith(outer)}
    completed = subprocess.run(
        [shutil.which("make") or "make", *arguments],
        cwd=ROOT,
        env={**clean, **({"PATH": path} if path else {}), **environ},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert completed.returncode == 0, completed.stderr
    return completed.stdout


@pytest.mark.promise("`make` lists every target.")
def test_make_alone_lists_every_target_with_its_help() -> None:
    output = make()
    (phony,) = re.findall(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for target in set(phony.split()) - {"$(LINTERS)", "fast-engine"}:  # called by other targets
        line = next(line for line in output.splitlines() if line.startswith(f"  make {target} "))
        assert len(line.split()) > 3, line
    assert make("help") == output


@pytest.mark.promise("`.ci/run` runs the linters, the type checker and all tests except the nightly ones.")
def test_ci_runs_lint_types_doctor_and_all_tests_but_the_nightly_ones() -> None:
    assert re.search(r"^make test ", (ROOT / ".ci" / "run").read_text(), re.MULTILINE)
    output = make("-n", "test")
    for command in ("lint-types", "lint-style", "lint-imports", "autograder doctor", "pytest -n 4", '-m "not nightly"'):
        assert command in output, command


@pytest.mark.promise("make check")
def test_make_check_lints_the_checks_and_runs_the_quick_unit_tests() -> None:
    output = make("-n", "check")
    for command in ("lint-types", "lint-style", "pytest -n 2", 'tests/unit -m "not slow"'):
        assert command in output, command


@pytest.mark.promise("make lint")
def test_make_lint_installs_its_tools_and_runs_the_linters() -> None:
    output = make("-n", "lint")
    assert re.search(r"autograder/bootstrap\.py.* --dev", output)
    for command in ("lint-types", "lint-standins", "lint-style", "lint-imports"):
        assert command in output, command


@pytest.mark.promise("make lab")
def test_make_lab_opens_jupyterlab_on_the_chapters() -> None:
    assert "bin/autograder ros jupyter lab --ServerApp.root_dir=chapters" in make("-n", "lab")


@pytest.mark.promise("make cluster")
def test_make_cluster_installs_the_pinned_packages_of_a_cluster_beside_the_course() -> None:
    output = make("-n", "cluster")
    assert "autograder/bootstrap.py" in output
    assert "--no-deps --require-hashes -r requirements-cluster.lock" in output


@pytest.fixture
def interpreters(tmp_path: Path) -> Path:
    """A folder for PATH with a shell and the tools of the Makefiles, but without a Python."""
    for tool in ("sh", "sed", "expand"):
        (tmp_path / tool).symlink_to(shutil.which(tool) or tool)
    return tmp_path


def write_interpreter(folder: Path, name: str, body: str) -> None:
    """Put an executable script into the folder."""
    (folder / name).write_text(f"#!/bin/sh\n{body}\n")
    (folder / name).chmod(0o755)


def chosen_interpreter(folder: Path, **environ: str) -> str:
    """Return the interpreter that the Makefiles of the course and of a release both choose.

    There is no system Python unless `SYSTEM_PYTHON` names one.
    """
    system = {"SYSTEM_PYTHON": "", **environ}
    (choice,) = {
        make("-n", "-f", str(makefile), "setup", path=str(folder), **system).split()[0]
        for makefile in (ROOT / "Makefile", STUDENTS)
    }
    return choice


def test_a_python_that_does_not_run_is_skipped(interpreters: Path) -> None:
    write_interpreter(interpreters, "python3.12", "echo 'pyenv: python3.12: command not found' >&2; exit 127")
    write_interpreter(interpreters, "python3", "exit 0")
    assert chosen_interpreter(interpreters) == "python3"


def test_an_interpreter_of_the_wrong_version_is_skipped(interpreters: Path) -> None:
    write_interpreter(interpreters, "python3", "exit 1")
    write_interpreter(interpreters, "python3.11", "exit 0")
    assert chosen_interpreter(interpreters) == "python3.11"


def test_the_python_of_the_system_is_preferred_to_one_built_by_hand(interpreters: Path) -> None:
    for name in ("system", "python3", "python3.13"):
        write_interpreter(interpreters, name, "exit 0")
    assert chosen_interpreter(interpreters, SYSTEM_PYTHON="system") == "system"


def test_the_python_of_the_platform_is_preferred(interpreters: Path) -> None:
    for name in ("python3.10", "python3.12", "python3"):
        write_interpreter(interpreters, name, "exit 0")
    assert chosen_interpreter(interpreters) == "python3.12"


def test_without_a_usable_python_the_makefile_takes_python3_and_the_set_up_reports_it(interpreters: Path) -> None:
    assert chosen_interpreter(interpreters) == "python3"


@pytest.mark.promise("`make PYTHON=...` uses the Python of your choice", "`make setup PYTHON=python3.12`")
def test_the_interpreter_that_the_user_chose_is_used(interpreters: Path) -> None:
    assert chosen_interpreter(interpreters, PYTHON="/opt/python3.13") == "/opt/python3.13"


def test_a_release_prefers_the_same_python_of_the_system_as_the_course() -> None:
    lines = [
        next(line for line in path.read_text().splitlines() if line.startswith("SYSTEM_PYTHON"))
        for path in (ROOT / "Makefile", STUDENTS)
    ]
    assert lines == ["SYSTEM_PYTHON ?= /usr/bin/python3"] * 2


def test_the_interpreter_chosen_on_this_machine_is_supported() -> None:
    name = make("-n", "setup").split()[0]
    code = "import sys; print(*sys.version_info[:2])"
    completed = subprocess.run([name, "-c", code], capture_output=True, text=True, timeout=60)
    assert (3, 10) <= tuple(map(int, completed.stdout.split())) <= (3, 13)
