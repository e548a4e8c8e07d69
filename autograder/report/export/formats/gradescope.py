"""Gradescope: a `results.json` for each submission, as Gradescope's autograder specification defines it.

The format: https://gradescope-autograders.readthedocs.io/en/latest/specs/ (output format, test cases, visibility).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from autograder.diagnosis import Kind
from autograder.plain_text import clean
from autograder.report.export.stored import per_student
from autograder.report.feedback.text import no_mark
from autograder.result.causes import causes
from autograder.result.model import CheckResult, Result, Status, write_json
from autograder.suite import Outcome, Visibility

FOLDER = True

# Students see the results of hidden checks when the marks are published.
VISIBILITY = {Visibility.VISIBLE: "visible", Visibility.HIDDEN: "after_published"}


def write(results: Sequence[Result], out: Path) -> Path:
    """Write `out/<student>/results.json` for each submission and return `out`."""
    for result, folder in per_student(results, out):
        write_json(folder / "results.json", report(result))
    return out


def report(result: Result) -> dict[str, Any]:
    """Return the content of one `results.json`.

    A submission that was not graded has neither score nor tests. Gradescope then reports a failed autograder.
    """
    if result.status is not Status.GRADED:
        return {"output": f"Not graded. {no_mark(result)}"}
    return {
        "score": result.score,
        "execution_time": round(result.seconds),
        "output": "" if result.diagnosis.kind is Kind.OK else clean(result.diagnosis.sentence),
        "output_format": "text",
        "stdout_visibility": "hidden",
        "tests": _tests(result),
        "extra_data": {"seed": result.seed, "suite_version": result.suite_version, "isolation": result.isolation},
    }


def _tests(result: Result) -> list[dict[str, Any]]:
    """Return the tests in the order of the suite. Consequences name their cause, as Gradescope cannot fold them."""
    all_causes = causes(result.checks, result.diagnosis.sentence)
    cause_of = {id(check): cause.check for cause in all_causes for check in cause.checks[1:]}
    return [_test(check, index, cause_of.get(id(check))) for index, check in enumerate(result.checks, start=1)]


def _test(check: CheckResult, index: int, cause: CheckResult | None) -> dict[str, Any]:
    lines: list[str] = []
    if check.outcome is not Outcome.PASSED and cause is not None:
        advice = f'Probably caused by "{cause.title}": fix that first and run again.'
        lines = [check.message, advice] if check.outcome is Outcome.FAILED else [f"Not checked. {advice}"]
    elif check.outcome is not Outcome.PASSED:
        hints = check.hints if check.outcome is Outcome.FAILED else ()
        lines = [check.message, *(f"Hint: {hint}" for hint in hints)]
    return {
        "number": str(index),
        "name": clean(check.title),
        "name_format": "text",
        "score": check.points,
        "max_score": check.max_points,
        "status": "passed" if check.outcome is Outcome.PASSED else "failed",
        "output": clean("\n".join(line for line in (*lines, check.doc or "") if line)),
        "output_format": "text",
        "tags": [check.group, check.outcome.value],
        "visibility": VISIBILITY[check.visibility],
    }
