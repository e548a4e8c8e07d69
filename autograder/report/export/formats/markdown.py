"""Markdown: a table of the submissions, and a table of checks for each of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from autograder.diagnosis import Kind
from autograder.report.feedback.text import no_mark, number, one_line
from autograder.result.causes import causes
from autograder.result.model import CheckResult, Result, Status
from autograder.suite import Outcome

FOLDER = False

MARKS = {Outcome.PASSED: "✓", Outcome.FAILED: "✗", Outcome.NOT_CHECKED: "-"}


def write(results: Sequence[Result], out: Path) -> Path:
    """Write the tables to `out`, and return it."""
    lines = ["| Submission | Assignment | Score | Diagnosis |", "|---|---|--:|---|"]
    lines += [
        f"| {_plain(r.student)} | {_plain(r.assignment)} | {_score(r)} | {_plain(_diagnosis(r))} |" for r in results
    ]
    for result in results:
        lines += ["", *_submission(result)]
    out.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return out


def _submission(result: Result) -> list[str]:
    lines = [f"## {_plain(result.student)}: {_score(result)}"]
    if _diagnosis(result):
        lines += ["", _plain(_diagnosis(result))]
    if result.status is Status.GRADED and result.checks:
        lines += ["", "| | Check | Points | Reason |", "|---|---|--:|---|", *_rows(result)]
    return lines


def _rows(result: Result) -> Iterator[str]:
    """Yield a row for each check. Consequences of a failure follow it, with an arrow."""
    for cause in causes(result.checks, result.diagnosis.sentence):
        yield _row(cause.check, cause.check.message)
        yield from (_row(check, f"↳ {check.message}") for check in cause.failed)
        yield from (_row(check, "↳ not checked") for check in cause.unchecked)


def _row(check: CheckResult, reason: str) -> str:
    shown_reason = "" if check.outcome is Outcome.PASSED else reason
    points = f"{number(check.points)} / {number(check.max_points)}"
    return f"| {MARKS[check.outcome]} | {_plain(check.title)} | {points} | {_plain(shown_reason)} |"


def _score(result: Result) -> str:
    if result.status is not Status.GRADED:
        return result.status.words
    return f"{number(result.score)} / {number(result.max_score)}"


def _diagnosis(result: Result) -> str:
    if result.status is not Status.GRADED:
        return no_mark(result)
    return "" if result.diagnosis.kind is Kind.OK else result.diagnosis.sentence


def _plain(text: str) -> str:
    """Return the text on one line, with Markdown and HTML markup escaped (CommonMark 2.4)."""
    return re.sub(r"([\\`*_\[\]<>|~&])", r"\\\1", one_line(text))
