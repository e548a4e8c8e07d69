"""`check`: the visible checks of an assignment, plain and friendly in the notebook and on the terminal."""

from __future__ import annotations

import html
import json
from dataclasses import dataclass
from pathlib import Path

from autograder import layout
from autograder.exceptions import UsageError
from autograder.notebook.cells_and_files import differences
from autograder.notebook.notices import INFO, STYLE, TROUBLE, Notice
from autograder.notebook.worker_client import run_in_worker
from autograder.result.causes import FAILED_AS_WELL, Cause, causes
from autograder.result.model import CheckResult, structure
from autograder.suite import Outcome, suites
from sim.grading import grading

SYMBOLS = {Outcome.PASSED: "✔", Outcome.FAILED: "✘", Outcome.NOT_CHECKED: "○"}
HIDDEN_CHECKS_HEADING = "After you hand in, {count} more checks judge, with inputs of their own:"
INDENT = 'style="margin-left:2em"'
COLOURS = {Outcome.PASSED: "#009e73", Outcome.FAILED: TROUBLE, Outcome.NOT_CHECKED: "#767676"}


@dataclass(frozen=True)
class CheckReport:
    """The visible checks' outcome.

    `trouble` is what kept the package from being built or the node from running. `later` holds the titles of the checks
    that judge the packages after they are handed in. `notices` are sentences about files that differ from their cells.
    """

    assignment: str
    lines: tuple[CheckResult, ...]
    trouble: Notice | None = None
    later: tuple[str, ...] = ()
    notices: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(line.outcome is Outcome.PASSED for line in self.lines)

    @property
    def summary(self) -> str:
        """The count in words."""
        good = sum(line.outcome is Outcome.PASSED for line in self.lines)
        return f"{self.assignment}: {good} of {len(self.lines)} visible checks passed."

    @property
    def causes(self) -> tuple[Cause, ...]:
        """The checks, each with those that did not pass because it did not."""
        return causes(self.lines, "" if self.trouble is None else self.trouble.sentence)

    def __repr__(self) -> str:
        parts = [line for notice in self.notices for line in (notice, "")]
        parts += [] if self.trouble is None else [repr(self.trouble), ""]
        for cause in self.causes:
            line = cause.check
            parts.append(_head(line))
            parts += [f"    {line.message}"] if line.message else []
            if line.outcome is Outcome.FAILED:
                parts += [f"    hint {number}: {hint}" for number, hint in enumerate(line.hints, 1)]
                parts += [f"    read: {line.doc}"] if line.doc else []
            parts += (
                [f"    {FAILED_AS_WELL}", *(f"    {_head(other)}" for other in cause.failed)] if cause.failed else []
            )
            parts += [f"    {cause.not_checked}"] if cause.not_checked else []
        parts += ["", self.summary]
        if self.passed and self.later:
            parts += ["", HIDDEN_CHECKS_HEADING.format(count=len(self.later)), *(f"- {title}" for title in self.later)]
        return "\n".join(parts)

    def _repr_html_(self) -> str:
        notices = "".join(Notice(notice)._repr_html_() for notice in self.notices)
        trouble = notices + ("" if self.trouble is None else self.trouble._repr_html_())
        colour = COLOURS[Outcome.PASSED] if self.passed else INFO
        rows = "".join(_cause(cause) for cause in self.causes)
        if self.passed and self.later:
            titles = "".join(f"<li>{html.escape(title)}</li>" for title in self.later)
            heading = HIDDEN_CHECKS_HEADING.format(count=len(self.later))
            rows += f"<details><summary>{heading}</summary><ul>{titles}</ul></details>"
        return f'{trouble}<div style="{STYLE.format(colour=colour)}"><b>{html.escape(self.summary)}</b>{rows}</div>'


def check(assignment: str, workspace: str | Path = "ws") -> CheckReport | Notice:
    """Run the visible checks on the packages of a workspace.

    The code path is the grader's own: the packages are built by colcon and the node runs in a process of its own.
    Raises GraderError if the check itself fails.
    """
    if grading():  # the sandbox holds no checks
        return Notice("The hidden checks run after this notebook has been executed.")
    if assignment not in (there := suites.checkable_assignments()):
        raise UsageError(f"there are no visible checks for {assignment!r}; there are for: {', '.join(there)}")
    with run_in_worker("check", Path(workspace), assignment=assignment) as (answer, _):
        diagnosis = answer["diagnosis"]
        trouble = None
        if diagnosis["kind"] != "ok":
            trouble = Notice(diagnosis["sentence"], diagnosis["detail"], TROUBLE)
        lines = tuple(structure(CheckResult, result) for result in answer["checks"])
    path = layout.judged_later(assignment)
    later = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else ()
    notices = differences(assignment, Path(workspace), suites.visible(assignment).sources)
    return CheckReport(assignment, lines, trouble, tuple(later), notices)


def _head(line: CheckResult) -> str:
    return f"{SYMBOLS[line.outcome]} {line.outcome.text:<11} {line.title}"


def _cause(cause: Cause) -> str:
    """Return the HTML of a check, with what did not pass because of it folded below it."""
    row = _row(cause.check)
    if cause.failed:
        rows = "".join(map(_row, cause.failed))
        row += f"<details {INDENT}><summary>{FAILED_AS_WELL} {len(cause.failed)}</summary>{rows}</details>"
    if cause.unnamed:
        titles = "".join(f"<li>{html.escape(title)}</li>" for title in cause.unnamed)
        return f"{row}<details {INDENT}><summary>{cause.not_checked}</summary><ul>{titles}</ul></details>"
    return row + (f"<div {INDENT}>{html.escape(cause.not_checked)}</div>" if cause.not_checked else "")


def _row(line: CheckResult) -> str:
    # The colour stands beside the words: there is none that can be read on white as well as on black.
    style = f"border-left: .5em solid {COLOURS[line.outcome]}; padding-left: .4em"
    mark = f'<span style="{style}">{SYMBOLS[line.outcome]} {line.outcome.text}</span>'
    row = f"<div>{mark} &nbsp;{html.escape(line.title)}</div>"
    if line.message:
        row += f"<div {INDENT}>{html.escape(line.message)}</div>"
    if line.outcome is not Outcome.FAILED:
        return row
    for number, hint in enumerate(line.hints, 1):
        row += f"<details {INDENT}><summary>hint {number}</summary>{html.escape(hint)}</details>"
    if line.doc:
        row += f'<div {INDENT}><a href="{html.escape(line.doc)}">read about it</a></div>'
    return row
