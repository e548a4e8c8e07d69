"""Renders the pages from the templates. All text is escaped. A page loads no other file and has no script."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from statistics import mean

import jinja2
from markupsafe import Markup

from autograder import layout
from autograder.checks import Outcome
from autograder.feedback.model import page_view
from autograder.feedback.pictures import picture_reader
from autograder.feedback.text import NOT_GRADED, clean, number
from autograder.result import Result, Status, write_atomically

TEMPLATES = layout.ROOT / "assets" / "templates"
PAGE = "feedback.html"
SUMMARY = "index.html"


@cache
def environment() -> jinja2.Environment:
    """Return the template environment. It escapes all text and raises for an unknown name."""

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


def write(result: Result, folder: Path, *, artifacts: Path | None = None) -> Path:
    """Write the feedback page of one submission and return its path.

    Args:
        result: the result to show.
        folder: folder that gets `feedback.html`.
        artifacts: folder of the result's pictures; `folder` if it is None.

    Raises:
        UsageError: the path of an artifact leads out of its folder.
    """
    page = page_view(result, picture_reader(artifacts or folder))
    return _write(folder / PAGE, environment().get_template("feedback.html.j2").render(page=page))


def write_summary(results: Sequence[Result], folder: Path) -> Path:
    """Write the table of a class's submissions and return its path.

    The row of a submission links to `folder/<student>/feedback.html` if that file exists.
    """
    graded = [result for result in results if result.status is Status.GRADED]
    html = (
        environment()
        .get_template("summary.html.j2")
        .render(
            assignments=list(dict.fromkeys(result.assignment for result in results)),
            rows=[(result, _link(result, folder), _reason(result)) for result in results],
            graded=graded,
            mean=mean(result.percent for result in graded) if graded else None,
            missed=_missed(graded),
        )
    )
    return _write(folder / SUMMARY, html)


def _link(result: Result, folder: Path) -> str | None:
    if (folder / result.student).resolve().parent != folder.resolve():
        return None
    return f"{result.student}/{PAGE}" if (folder / result.student / PAGE).is_file() else None


def _reason(result: Result) -> str:
    """Return a sentence that says why points are missing."""
    page = page_view(result, lambda artifact: None)
    if not page.started:
        return result.diagnosis.sentence
    if not page.graded:
        return NOT_GRADED
    return (page.first.message or page.first.title) if page.first else ""


def _missed(results: Sequence[Result]) -> list[tuple[str, int, int]]:
    """Return (title, passed, graded) of each check that a submission did not pass, the most missed first."""
    counts: dict[str, tuple[str, int, int]] = {}
    for check in (check for result in results for check in result.checks):
        title, passed, total = counts.get(check.id, (check.title, 0, 0))
        counts[check.id] = (title, passed + (check.outcome is Outcome.PASSED), total + 1)
    return sorted((entry for entry in counts.values() if entry[1] < entry[2]), key=lambda e: e[1] / e[2])


def _write(path: Path, html: str) -> Path:
    write_atomically(path, html.encode("utf-8"))
    return path
