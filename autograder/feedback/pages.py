"""Pages from the report templates. Everything is escaped; a page loads nothing and runs nothing."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from statistics import mean

import jinja2
from markupsafe import Markup

from autograder import layout
from autograder.checks import Outcome, Visibility
from autograder.feedback.model import view
from autograder.feedback.pictures import from_folder
from autograder.feedback.text import NOT_GRADED, clean, number
from autograder.result import Result, Status

TEMPLATES = layout.ROOT / "assets" / "templates"
PAGE = "feedback.html"
SUMMARY = "index.html"


@cache
def environment() -> jinja2.Environment:
    """Return the template environment: everything escaped, an unknown name is an error."""

    def presentable(value: object) -> object:
        return clean(value) if isinstance(value, str) and not isinstance(value, Markup) else value

    found = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=presentable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    found.filters["number"] = number
    found.globals["not_graded"] = NOT_GRADED
    found.globals["style"] = Markup((TEMPLATES / "report.css").read_text(encoding="utf-8"))
    return found


def write(result: Result, folder: Path, *, artifacts: Path | None = None, after_due: bool = False) -> Path:
    """Write the feedback page of one submission and return its path.

    Args:
        result: the graded submission.
        folder: where `feedback.html` goes.
        artifacts: the result's folder, from which its pictures are read; by default the same.
        after_due: also show the checks that stay closed until the due date.

    Raises:
        UsageError: an artifact's name leads out of its folder.
    """
    page = view(result, from_folder(artifacts or folder), after_due=after_due)
    return _put(folder / PAGE, environment().get_template("feedback.html.j2").render(page=page))


def write_summary(results: Sequence[Result], folder: Path, *, after_due: bool = False) -> Path:
    """Write the table of a class's submissions and return its path.

    A submission's row links to `folder/<student>/feedback.html` where that file exists. `after_due` also names the
    checks that stay closed until the due date.
    """
    graded = [result for result in results if result.status is Status.GRADED]
    html = (
        environment()
        .get_template("summary.html.j2")
        .render(
            assignments=list(dict.fromkeys(result.assignment for result in results)),
            rows=[(result, _link(result, folder), _reason(result, after_due)) for result in results],
            graded=graded,
            mean=mean(result.percent for result in graded) if graded else None,
            missed=_missed(graded, after_due),
        )
    )
    return _put(folder / SUMMARY, html)


def _link(result: Result, folder: Path) -> str | None:
    if (folder / result.student).resolve().parent != folder.resolve():
        return None
    return f"{result.student}/{PAGE}" if (folder / result.student / PAGE).is_file() else None


def _reason(result: Result, after_due: bool) -> str:
    """Say in one sentence why points are missing."""
    page = view(result, lambda artifact: None, after_due=after_due)
    if not page.good:
        return result.diagnosis.sentence
    if not page.graded:
        return NOT_GRADED
    return (page.first.message or page.first.title) if page.first else ""


def _missed(results: Sequence[Result], after_due: bool) -> list[tuple[str, int, int]]:
    """Return (title, passed, of how many) of each check that someone did not pass, the most missed first."""
    counts: dict[str, tuple[str, int, int]] = {}
    for check in (check for result in results for check in result.checks):
        if check.visibility is Visibility.AFTER_DUE and not after_due:
            continue
        title, passed, total = counts.get(check.id, (check.title, 0, 0))
        counts[check.id] = (title, passed + (check.outcome is Outcome.PASSED), total + 1)
    return sorted((entry for entry in counts.values() if entry[1] < entry[2]), key=lambda e: e[1] / e[2])


def _put(path: Path, html: str) -> Path:
    """Write a page whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(f".{path.name}.{os.getpid()}")
    fresh.write_text(html, encoding="utf-8")
    fresh.replace(path)
    return path
