"""Runs `colcon test` on a student's package in the sandbox."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from autograder.building.colcon import HOST, colcon_command
from autograder.probes.installed import Installed
from autograder.probes.test_reports import Claims, Report, read_claims
from autograder.probes.test_runs import sandboxed
from autograder.sandbox import Ending, Mount
from autograder.sandbox.launcher import launch
from autograder.sandbox.limits import BUILD
from autograder.workspace import Workspace

TEST_EXTRAS = ("test", "tests", "testing")  # in which colcon looks for pytest


def colcon_test(workspace: Workspace, package: str, *arguments: str) -> Report:
    """Run `colcon test --packages-select PACKAGE --return-code-on-test-failure ARGUMENTS...` in a built workspace.

    Its build and test folders are written to.

    Returns:
        What colcon says: its exit status, and the tests in the file that its `test-result` would count. Where it had to
        be stopped, that of a second run, as in `test_runs.run`.
    """
    first = _colcon_test(workspace, package, arguments)
    return first if first.ending is not Ending.WALL_TIME else _colcon_test(workspace, package, arguments)


def runs_pytest(workspace: Workspace, installed: Installed) -> bool:
    """Return whether `colcon test` runs pytest on a built package, as it does if setup.py names pytest.

    It does where `extras_require` names it, with every setuptools. Otherwise colcon itself answers, because the answer
    depends on the platform: a setuptools before 72.0, such as the 68.1.2 of Ubuntu 24.04, reads `tests_require`, too.
    The tests are collected and not run.
    """
    named = {re.split(r"[ <=>!~\[;]", line)[0] for extra in TEST_EXTRAS for line in installed.extras.get(extra, ())}
    if "pytest" in named:
        return True
    colcon_test(workspace, installed.package, "--pytest-args", "--collect-only")
    return _report(workspace, installed.package).is_file()


def _report(workspace: Workspace, package: str) -> Path:
    """Return the path of the file that pytest writes if colcon runs it."""
    return workspace.root / "build" / package / "pytest.xml"


def _colcon_test(workspace: Workspace, package: str, arguments: tuple[str, ...]) -> Report:
    choice = ("--packages-select", package, "--return-code-on-test-failure", *arguments)
    plain = sandboxed(workspace, HOST, limits=BUILD)
    environment = {**plain.environment, "COLCON_HOME": str(workspace.scratch)}
    del environment["PYTEST_DISABLE_PLUGIN_AUTOLOAD"]  # colcon is the student's own way to run them, plug-ins and all
    mounts = tuple(mount for mount in plain.mounts if mount.path != workspace.install)
    spec = replace(
        plain, workdir=workspace.root, environment=environment, mounts=(*mounts, Mount(workspace.root, writable=True))
    )
    report = _report(workspace, package)
    if _inside(report, workspace.root):
        report.unlink(missing_ok=True)
    with launch(colcon_command(workspace, "test", *choice), spec, profile="colcon") as process:
        process.wait(BUILD.wall_seconds + 10)
        ending, status, output = process.ending, process.returncode, process.output
    claims = read_claims(report) if _inside(report, workspace.root) else None
    return Report(ending, status, claims or Claims(), 0, output)


def _inside(path: Path, root: Path) -> bool:
    """Return whether a path that the build has made stays below `root`."""
    try:
        return path.parent.resolve().is_relative_to(root.resolve())
    except (OSError, RuntimeError):
        return False
