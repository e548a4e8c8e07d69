"""Runs the linters on a student's package, as the grader's own check.

A test called `test_flake8` does not necessarily call flake8. So the tests that `ros2 pkg create` writes replace the
student's. They read only the Python files of the package, in a subfolder from which nothing is imported. Therefore, a
configuration, a conftest.py, a module with a linter's name or a comment that disables a linter has no effect. After
that, the student's own tests have to find mistakes of style in a copy.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace

from autograder.probes import student_test_runs
from autograder.probes.fault_injection import UNTIDY, expect_failures
from autograder.probes.student_test_reports import Source, TestRun
from autograder.ros.ros2.pkg_templates import PYTHON_TESTS
from autograder.run.workspace import Workspace
from autograder.suite import CheckFailed

SUBFOLDER = "package"  # the folder for the package's files
# Comments that make flake8, pycodestyle and pydocstyle skip a line or a file. They are replaced by equally long text.
_DISABLING_COMMENT = re.compile(rb"(#\s*(?:flake8\s*[:=]\s*)?no)(qa|pep8)", re.IGNORECASE)
# The output format of each linter.
_FINDINGS = {
    "test_flake8": re.compile(r"^\./(\S+:\d+:\d+: [A-Z]+\d+ .*)$", re.MULTILINE),
    "test_pep257": re.compile(r"^\./(\S+:\d+ .*: D\d+: .*)$", re.MULTILINE),
}


def expect_tidy(workspace: Workspace, source: Source, tests: Collection[str], fraction: float = 0.0) -> None:
    """Fail the check if a linter finds a mistake that the student's test misses, or if a test passes on an untidy copy.

    Args:
        workspace: the built workspace.
        source: the package.
        tests: the student's tests that run the linters, `module::name`.
        fraction: the share of the points for an untidy package.
    """
    for name, finding in lint(workspace, source).items():
        sentence = f"{name} passes, but its linter finds something in the package: {finding}"
        raise CheckFailed(sentence, fraction=fraction)
    expect_failures(workspace, source, tests, {f"{source.package}/untidy.py": UNTIDY, "test/untidy.py": UNTIDY})


def _without_effect(comment: re.Match[bytes]) -> bytes:
    return comment[1] + b"x" * len(comment[2])


def lint(workspace: Workspace, source: Source) -> dict[str, str]:
    """Run flake8 and pep257 on a package; return the first finding of each, by the name of its test.

    The student's own tests with these names are not linted.
    """
    tests = [f"{name}.py" for name in _FINDINGS]
    own_tests = {f"test/{name}" for name in tests}
    sources = {name: data for name, data in source.files.items() if name.endswith(".py") and name not in own_tests}
    files = {f"{SUBFOLDER}/{name}": _DISABLING_COMMENT.sub(_without_effect, data) for name, data in sources.items()}
    files |= {f"test/{name}": PYTHON_TESTS[name].encode() for name in tests}
    empty = replace(workspace, root=workspace.root.with_name(f"{workspace.root.name}-style"))
    empty.install.mkdir(parents=True, exist_ok=True)
    (report,) = student_test_runs.run(empty, replace(source, files=files), [TestRun(tuple(tests), conftest=False)])
    messages: dict[str, str] = {}
    for name, finding in _FINDINGS.items():
        test = f"{name}::{name}"
        if test not in report.executed or test in report.failed:
            match = finding.search(report.output)
            messages[name] = (
                match[1].removeprefix(f"{SUBFOLDER}/") if match else report.claims.messages.get(test, "it did not run")
            )
    return messages
