"""Tests whether tests fail on a faulty copy of their package, where a test that asserts nothing still passes."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path

from autograder.probes import student_test_runs
from autograder.probes.student_test_reports import ClaimedOutcome, Source, TestRun
from autograder.probes.versions import Version
from autograder.run.workspace import Workspace
from autograder.suite import expect

# Code that flake8 and pep257 report: an unused name, and a docstring that is not a sentence.
UNTIDY = '"""no sentence"""\n\nimport os\n\n\n'


def expect_failures(workspace: Workspace, source: Source, tests: Collection[str], faults: Mapping[str, str]) -> None:
    """Fail the check unless each test fails on a faulty copy of its package.

    Args:
        workspace: the built workspace.
        source: the package.
        tests: the tests, `module::name` without parameters.
        faults: the new text of each faulty file, by its path below the package's folder.
    """
    modules = {test.partition("::")[0] for test in tests}
    files = sorted(name for name in source.tests if Path(name).suffix == ".py" and Path(name).stem in modules)
    sources = {
        name: data.decode(errors="replace") for name, data in source.files.items() if not name.startswith("test/")
    }
    # The report is not secret, because no part of it is quoted: its names are only compared with those in `tests`.
    test_run = TestRun(tuple(files), Version({**sources, **faults}, {}), is_public=True)
    (report,) = student_test_runs.run(workspace, source, [test_run])
    pairs = [(name.partition("[")[0], verdict) for name, verdict in report.claims.verdicts.items()]
    for test in tests:
        verdicts = {verdict for name, verdict in pairs if name == test}
        outcome = "was skipped" if ClaimedOutcome.SKIPPED in verdicts else "passed" if verdicts else "did not run"
        clause = f"The checks put a fault into {' and '.join(faults)} of a copy of your package"
        expect(verdicts == {ClaimedOutcome.FAILED}, f"{clause}, and {test.partition('::')[2]} {outcome}.")
