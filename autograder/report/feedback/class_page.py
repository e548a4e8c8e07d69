"""The page of a class: a table of submissions that can be sorted and filtered, and statistics."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import mean
from urllib.parse import quote

from markupsafe import Markup

from autograder.report.feedback.model import page_view
from autograder.report.feedback.pages import PAGE, TEMPLATES, digest, write_page
from autograder.report.feedback.statistics import class_statistics
from autograder.report.feedback.text import no_mark
from autograder.result.class_folder import SUMMARY
from autograder.result.model import Result, Status
from autograder.suite import Outcome


@dataclass(frozen=True)
class Choice:
    """A choice in the filter of the table.

    Attributes:
        number: its index among the choices.
        group: its heading.
        label: its label.
        indices: the indices of the results that it shows.
    """

    number: int
    group: str
    label: str
    indices: frozenset[int]


def choices(results: Sequence[Result]) -> tuple[Choice, ...]:
    """Return the choices that show some of the results, but not all. Checks with the most failures come first."""
    marks: dict[str, set[int]] = {"Not graded": set(), "Less than half": set(), "Full marks": set()}
    missed_by: dict[tuple[str, str], set[int]] = {}
    titles: dict[tuple[str, str], str] = {}
    for index, result in enumerate(results):
        if result.status is not Status.GRADED:
            marks["Not graded"].add(index)
        elif result.percent < 50.0:
            marks["Less than half"].add(index)
        elif result.score >= result.max_score:
            marks["Full marks"].add(index)
        for check in result.checks:
            if check.outcome is not Outcome.PASSED:
                key = result.assignment, check.id
                missed_by.setdefault(key, set()).add(index)
                titles.setdefault(key, check.title)
    checks = [(titles[key], indices) for key, indices in sorted(missed_by.items(), key=lambda item: -len(item[1]))]
    all_choices = [("Marks", *item) for item in marks.items()] + [("Missed a check", *item) for item in checks]
    useful_choices = [choice for choice in all_choices if 0 < len(choice[2]) < len(results)]
    return tuple(
        Choice(number, group, label, frozenset(indices))
        for number, (group, label, indices) in enumerate(useful_choices)
    )


def write_summary(results: Sequence[Result], folder: Path) -> Path:
    """Write the table of a class's submissions and return its path.

    The row of a submission links to `folder/<student>/feedback.html` if that file exists.
    """
    graded = [result for result in results if result.status is Status.GRADED]
    script = (TEMPLATES / "class_table.js").read_text(encoding="utf-8")
    return write_page(
        folder / SUMMARY,
        "summary.html.j2",
        assignments=list(dict.fromkeys(result.assignment for result in results)),
        rows=[(result, _link(result, folder), _reason(result)) for result in results],
        choices=choices(results),
        graded=graded,
        mean=mean(result.percent for result in graded) if graded else None,
        statistics=class_statistics(graded) if graded else None,
        script=Markup(script),
        script_digest=digest(script),
    )


def _link(result: Result, folder: Path) -> str | None:
    if (folder / result.student).resolve().parent != folder.resolve():
        return None
    # The name of a folder may not be valid UTF-8, for example if it comes from a zip.
    return f"{quote(os.fsencode(result.student))}/{PAGE}" if (folder / result.student / PAGE).is_file() else None


def _reason(result: Result) -> str:
    """Return a sentence with the main reason for lost points."""
    page = page_view(result, None)
    if not page.graded:
        return no_mark(result)
    if not page.started:
        return result.diagnosis.sentence
    return (page.costliest.message or page.costliest.title) if page.costliest else ""
