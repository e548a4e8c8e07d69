"""Runs `colcon test` on a student's package in the sandbox.

colcon first runs setup.py, which could write the same files as pytest. So each run has a unique name, which pytest
includes in its report, and a report with another name is ignored.
"""

from __future__ import annotations

import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from autograder.building.colcon import RUNNER, colcon_command
from autograder.probes.files import read_below
from autograder.probes.installed import Installed
from autograder.probes.student_test_reports import MAX_BYTES, Claims, Report, parse_claims
from autograder.probes.student_test_runs import sandboxed
from autograder.run.sandbox import ExitReason, Mount
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import COLCON_TEST
from autograder.run.workspace import Workspace
from autograder.submission.packages import find_packages
from autograder.submission.reading import reading
from autograder.suite import expect

TEST_EXTRAS = ("test", "tests", "testing")  # the extras in which colcon looks for pytest


def colcon_test(workspace: Workspace, package: str) -> Report:
    """Run `colcon test --packages-select PACKAGE --return-code-on-test-failure` in a built workspace.

    It writes to a copy of the workspace, or to the workspace itself with `Isolation.PROCESS`, which mounts nothing.

    Returns:
        colcon's exit status, and the tests in the file that `colcon test-result` would count. If the first run had to
        be stopped, both are from a second run, as in `student_test_runs.run`.
    """
    first, _ = _colcon_test(workspace, package)
    return first if first.exit_reason is not ExitReason.WALL_TIME else _colcon_test(workspace, package)[0]


def expect_ended(report: Report) -> None:
    """Fail the check if `colcon test` had to be stopped: it then has no result file, whatever ran earlier."""
    expect(
        report.exit_reason is not ExitReason.WALL_TIME,
        f"`colcon test` did not end within {COLCON_TEST.wall_seconds:g} s and was stopped: look for a test that waits "
        "without a deadline.",
    )


def runs_pytest(workspace: Workspace, installed: Installed) -> bool:
    """Return whether `colcon test` runs pytest on a built package, as it does if setup.py names pytest.

    With any version of setuptools, it does if `extras_require` names pytest. Otherwise it depends on the platform:
    setuptools before 72.0, such as 68.1.2 in Ubuntu 24.04, also reads `tests_require`. In this case, colcon itself is
    run, but only collects the tests.
    """
    projects = {re.split(r"[ <=>!~\[;]", line)[0] for extra in TEST_EXTRAS for line in installed.extras.get(extra, ())}
    return "pytest" in projects or _colcon_test(workspace, installed.package, "--collect-only")[1]


def _colcon_test(workspace: Workspace, package: str, *pytest_arguments: str) -> tuple[Report, bool]:
    """Return the report, and whether pytest has written one."""
    run_name = secrets.token_hex(8)
    options = ["--packages-select", package, "--return-code-on-test-failure"]
    options += ["--pytest-args", "-o", f"junit_suite_name={run_name}", *pytest_arguments]
    packages, _ = find_packages(workspace.root / "src")
    spec = sandboxed(workspace, RUNNER, limits=COLCON_TEST)
    environment = {**spec.environment, "COLCON_HOME": str(workspace.scratch)}
    del environment["PYTEST_DISABLE_PLUGIN_AUTOLOAD"]  # students also run colcon with all plug-ins
    mounts = tuple(mount for mount in spec.mounts if mount.path != workspace.install)
    with _copy_of(workspace.root) as copy:
        mounts += (Mount(workspace.root, writable=True, source=copy),)
        spec = replace(spec, workdir=workspace.root, environment=environment, mounts=mounts)
        with launch(colcon_command(workspace, packages.values(), "test", *options), spec, profile="colcon") as process:
            process.wait(COLCON_TEST.wall_seconds + 10)
            exit_reason, status, output = process.exit_reason, process.returncode, process.output
        # With `Isolation.PROCESS`, the report is in the workspace itself.
        reports = [read_below(root, Path("build", package, "pytest.xml"), MAX_BYTES) for root in (copy, workspace.root)]
    own_report = next((report for report in reports if report and run_name.encode() in report), None)
    claims = parse_claims(own_report) if own_report else None
    return Report(exit_reason, status, claims or Claims(), 0, output), claims is not None


@contextmanager
def _copy_of(root: Path) -> Iterator[Path]:
    """Copy a workspace for one run, whose code may write to the copy. Later checks read the workspace itself."""
    copy = root.with_name(f"{root.name}-tested")  # not in scratch, where students' code may write
    with reading("The files that colcon built"):
        shutil.copytree(root, copy, symlinks=True)
    try:
        yield copy
    finally:
        shutil.rmtree(copy, ignore_errors=True)
