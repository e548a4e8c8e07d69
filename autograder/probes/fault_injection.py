"""Whether tests fail when a fault is laid into a copy of their package. One that calls or asserts nothing passes."""

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
    own = {name: data.decode(errors="replace") for name, data in source.files.items() if not name.startswith("test/")}
    # Nothing that the run says is quoted: it is only compared with the names in `tests`.
    test_run = TestRun(tuple(files), Version({**own, **faults}, {}), shown=True)
    (report,) = student_test_runs.run(workspace, source, [test_run])
    pairs = [(name.partition("[")[0], verdict) for name, verdict in report.claims.verdicts.items()]
    for test in tests:
        verdicts = {verdict for name, verdict in pairs if name == test}
        how = "was skipped" if ClaimedOutcome.SKIPPED in verdicts else "passed" if verdicts else "did not run"
        saw = f"The checks put a fault into {' and '.join(faults)} of a copy of your package"
        expect(verdicts == {ClaimedOutcome.FAILED}, f"{saw}, and {test.partition('::')[2]} {how}.")
