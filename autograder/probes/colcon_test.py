"""Runs `colcon test` on a student's package in the sandbox.

colcon runs setup.py and the student's tests in the same sandbox, so they can write any report: each run has a unique
name, which keeps an older report from being taken for a new one, but setup.py can read it, and a test can change pytest
itself. So a report is a claim. Whether setup.py names pytest is read from what the build installed and from the source,
and a report without it does not count. A check that needs more than the claim that the student's own tests pass has to
run the program itself.
"""

from __future__ import annotations

import ast
import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from autograder.building.colcon import RUNNER, colcon_command
from autograder.probes.files import parse_python, read_below, read_plain
from autograder.probes.installed import Installed, inspect_package
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
MAX_SETUP_BYTES = 256 * 1024  # of setup.py and setup.cfg; no more is searched for `tests_require`


def colcon_test(workspace: Workspace, package: str) -> Report:
    """Run `colcon test --packages-select PACKAGE --return-code-on-test-failure` in a built workspace.

    It writes to a copy of the workspace, or to the workspace itself with `Isolation.PROCESS`, which mounts nothing.

    Returns:
        colcon's exit status, and the tests in the file that `colcon test-result` would count. If the first run had to
        be stopped, both are from a second run, as in `student_test_runs.run`. If setup.py does not name pytest, nothing
        is run, and there are no tests.
    """
    installed = inspect_package(workspace.install, package)
    if not (_extras_name_pytest(installed) or _source_names_pytest(workspace, package)):
        return Report(None, None, Claims(), 0, "")
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
    setuptools before 72.0, such as 68.1.2 in Ubuntu 24.04, also reads `tests_require`, which the build does not record.
    If the source names it, colcon itself is run, but only collects the tests.
    """
    if _extras_name_pytest(installed):
        return True
    return (
        _source_names_pytest(workspace, installed.package)
        and _colcon_test(workspace, installed.package, "--collect-only")[1]
    )


def _extras_name_pytest(installed: Installed) -> bool:
    lines = [line for extra in TEST_EXTRAS for line in installed.extras.get(extra, ())]
    return "pytest" in {re.split(r"[ <=>!~\[;]", line)[0] for line in lines}


def _source_names_pytest(workspace: Workspace, package: str) -> bool:
    """Return whether setup.py or setup.cfg contains both `tests_require` and pytest.

    A file that forges a report would have to contain both, too, which is no less work than naming pytest.
    """
    folder = find_packages(workspace.root / "src")[0].get(package)
    if folder is None:
        return False
    tree = parse_python(read_plain(folder / "setup.py", MAX_SETUP_BYTES) or b"")
    nodes = list(ast.walk(tree)) if tree else []
    words = {node.arg for node in nodes if isinstance(node, ast.keyword)}
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            words.update(_words(node.value))
    settings = (read_plain(folder / "setup.cfg", MAX_SETUP_BYTES) or b"").decode(errors="replace")
    return any({"tests_require", "pytest"} <= found for found in (words, _words(settings)))


def _words(text: str) -> set[str]:
    return set(re.findall(r"[\w./-]+", text))


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
