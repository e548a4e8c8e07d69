"""`check` runs the visible checks of an assignment and reports them in a notebook or terminal."""

from __future__ import annotations

import html
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.notebook.cells_and_files import differences
from autograder.notebook.exercises import KINDS, Exercise, exercises, find_exercise
from autograder.notebook.notices import INFO, STYLE, TROUBLE, Notice
from autograder.notebook.stored_results import StoredResult, current_inputs, load, store
from autograder.notebook.worker_client import run_in_worker
from autograder.result.causes import FAILED_AS_WELL, Cause, causes
from autograder.result.model import CheckResult, structure
from autograder.suite import Outcome, suites
from sim.grading import grading

SYMBOLS = {Outcome.PASSED: "✔", Outcome.FAILED: "✘", Outcome.NOT_CHECKED: "○"}
HIDDEN_CHECKS_HEADING = "After you submit, {count} more checks run with their own inputs:"
UNCHANGED = "Unchanged since {since}, so nothing was run."
FAILED_BEFORE = "previously failed checks"
INDENT = 'style="margin-left:2em"'
COLOURS = {Outcome.PASSED: "#009e73", Outcome.FAILED: TROUBLE, Outcome.NOT_CHECKED: "#767676"}


@dataclass(frozen=True)
class Part:
    """What to check: a whole chapter (`name` is empty), or one of its `exercises`."""

    assignment: str
    name: str = ""
    exercises: tuple[Exercise, ...] = ()

    @property
    def later(self) -> tuple[str, ...]:
        """The files that only cells after this exercise write."""
        return next((exercise.later for exercise in self.exercises if exercise.name == self.name), ())


@dataclass(frozen=True)
class CheckReport:
    """The results of the visible checks.

    `trouble` is the reason why the package could not be built or the node could not run. `later` are the titles of the
    checks that run after submission. `notices` are sentences about files that differ from their cells. `part` is the
    name of the exercise that was checked; it is empty for the whole chapter. `since` is the time of the stored run; it
    is empty if the checks were run now.
    """

    assignment: str
    lines: tuple[CheckResult, ...]
    trouble: Notice | None = None
    later: tuple[str, ...] = ()
    notices: tuple[str, ...] = ()
    part: str = ""
    since: str = ""

    @property
    def passed(self) -> bool:
        return all(line.outcome is Outcome.PASSED for line in self.lines)

    @property
    def shown_trouble(self) -> Notice | None:
        """The trouble; None if all checks of an exercise passed, because then another exercise's package causes it."""
        return None if self.part and self.passed else self.trouble

    @property
    def summary(self) -> str:
        """A sentence with the number of passed checks."""
        passed_count = sum(line.outcome is Outcome.PASSED for line in self.lines)
        checked_part = ", ".join(filter(None, (self.assignment, self.part)))
        unchanged_note = f" {UNCHANGED.format(since=self.since)}" if self.since else ""
        return f"{checked_part}: {passed_count} of {len(self.lines)} visible checks passed.{unchanged_note}"

    @property
    def causes(self) -> tuple[Cause, ...]:
        """The checks, each with the other checks that did not pass because of it."""
        return causes(self.lines, "" if self.trouble is None else self.trouble.sentence)

    def __repr__(self) -> str:
        parts = [line for notice in self.notices for line in (notice, "")]
        parts += [] if self.shown_trouble is None else [repr(self.shown_trouble), ""]
        for cause in self.causes:
            line = cause.check
            parts.append(_headline(line))
            parts += [f"    {line.message}"] if line.message else []
            if line.outcome is Outcome.FAILED:
                parts += [f"    hint {number}: {hint}" for number, hint in enumerate(line.hints, 1)]
                parts += [f"    read: {line.doc}"] if line.doc else []
            parts += (
                [f"    {FAILED_AS_WELL}", *(f"    {_headline(consequence)}" for consequence in cause.failed)]
                if cause.failed
                else []
            )
            parts += [f"    {cause.not_checked}"] if cause.not_checked else []
        parts += ["", self.summary]
        if self.passed and self.later:
            parts += ["", HIDDEN_CHECKS_HEADING.format(count=len(self.later)), *(f"- {title}" for title in self.later)]
        return "\n".join(parts)

    def _repr_html_(self) -> str:
        notices = "".join(Notice(notice)._repr_html_() for notice in self.notices)
        trouble = notices + ("" if self.shown_trouble is None else self.shown_trouble._repr_html_())
        colour = COLOURS[Outcome.PASSED] if self.passed else INFO
        rows = "".join(_cause_html(cause) for cause in self.causes)
        if self.passed and self.later:
            titles = "".join(f"<li>{html.escape(title)}</li>" for title in self.later)
            heading = HIDDEN_CHECKS_HEADING.format(count=len(self.later))
            rows += f"<details><summary>{heading}</summary><ul>{titles}</ul></details>"
        return f'{trouble}<div style="{STYLE.format(colour=colour)}"><b>{html.escape(self.summary)}</b>{rows}</div>'


def check(
    assignment: str,
    workspace: str | Path = "ws",
    *,
    exercise: int | None = None,
    step: int | None = None,
    question: int | None = None,
    fresh: bool = False,
) -> CheckReport | Notice:
    """Run the visible checks of a chapter, or of one exercise of it, on the packages of a workspace.

    It uses the same code as the grader: colcon builds the packages, and the node runs in a separate process. A stored
    result is reused while everything that it depends on is unchanged. The report then shows its time.

    Args:
        assignment: the chapter.
        workspace: a colcon workspace.
        exercise: the number of an exercise, if the notebook has exercises.
        step: the number of a step, if it has steps.
        question: the number of a question, if it has questions.
        fresh: whether to run the checks even if nothing has changed.

    Raises:
        UsageError: the chapter, exercise or workspace does not exist.
        GraderError: the check itself failed.
    """
    if grading():  # the sandbox contains no checks
        return Notice("The hidden checks run after this notebook has been executed.")
    return run_part(part_of(assignment, exercise, step, question), Path(workspace), fresh=fresh)


def part_of(assignment: str, exercise: int | None, step: int | None, question: int | None) -> Part:
    """Return the exercise, step or question with the given number, or the whole chapter if no number is given.

    Raises:
        UsageError: the chapter or part does not exist, or two parts are given.
    """
    if assignment not in (known_assignments := suites.checkable_assignments()):
        raise UsageError(f"{assignment!r} has no visible checks; choose one of: {', '.join(known_assignments)}")
    numbers = zip(KINDS, (exercise, step, question), strict=True)
    requested_parts = [(kind, number) for kind, number in numbers if number is not None]
    if not requested_parts:
        return Part(assignment)
    if len(requested_parts) > 1:
        listed_parts = " and ".join(f"{kind} {number}" for kind, number in requested_parts)
        raise UsageError(
            f"{listed_parts} are two parts of {assignment}: ask for one at a time, or for the whole chapter"
        )
    available = exercises(assignment)
    return Part(assignment, find_exercise(assignment, available, *requested_parts[0]).name, available)


def run_part(
    part: Part,
    workspace: Path,
    *,
    fresh: bool = False,
    first: Sequence[str] = (),
    early: Callable[[CheckReport], None] | None = None,
) -> CheckReport:
    """Run the checks of a part of a chapter, unless there is a stored result for the same inputs.

    Args:
        part: the part to check.
        workspace: a colcon workspace.
        fresh: whether to run the checks even if nothing has changed.
        first: ids of checks to run before the others.
        early: a function that is called with the report of the checks in `first` while the others run.

    Raises:
        UsageError: the workspace does not exist.
        GraderError: the check itself failed.
    """
    stored_result = load(workspace, part.assignment, part.name)
    reads = () if stored_result is None else stored_result.reads
    inputs = current_inputs(part.assignment, workspace / "src", reads)
    if stored_result is not None and inputs is not None and stored_result.digest == inputs.digest and not fresh:
        return _make_report(part, workspace, stored_result.reply, stored_result.since)

    def report_early(reply: dict[str, Any]) -> None:
        if early is not None:
            early(_make_report(replace(part, name=FAILED_BEFORE), workspace, reply))

    arguments = {"exercises": [asdict(exercise) for exercise in part.exercises], "part": part.name, "first": [*first]}
    with run_in_worker("check", workspace, early=report_early, assignment=part.assignment, **arguments) as (reply, _):
        created_at = datetime.now().isoformat(timespec="seconds")
    is_unchanged = inputs is not None and inputs == current_inputs(part.assignment, workspace / "src", reads)
    digest = inputs.digest if inputs is not None and is_unchanged and reply["lasting"] else ""
    new_reads = tuple(reply["reads"])
    store(
        workspace,
        part.assignment,
        part.name,
        StoredResult(digest if new_reads == reads else "", created_at, new_reads, reply),
    )
    return _make_report(part, workspace, reply)


def _make_report(part: Part, workspace: Path, reply: dict[str, Any], since: str = "") -> CheckReport:
    """Return the report of a worker's reply, with notices about current files that differ from their cells."""
    diagnosis, trouble = reply["diagnosis"], None
    if diagnosis["kind"] != "ok":
        trouble = Notice(diagnosis["sentence"], diagnosis["detail"], TROUBLE)
    lines = tuple(structure(CheckResult, result) for result in reply["checks"])
    path = course_paths.hidden_titles(part.assignment)
    later = json.loads(path.read_text(encoding="utf-8")) if path.is_file() and not part.name else ()
    notices = differences(part.assignment, workspace, reply["sources"], part.later)
    return CheckReport(part.assignment, lines, trouble, tuple(later), notices, part.name, since)


def _headline(line: CheckResult) -> str:
    return f"{SYMBOLS[line.outcome]} {line.outcome.text:<11} {line.title}"


def _cause_html(cause: Cause) -> str:
    """Return the HTML of a check, with its consequences folded below it."""
    row = _row_html(cause.check)
    if cause.failed:
        rows = "".join(map(_row_html, cause.failed))
        row += f"<details {INDENT}><summary>{FAILED_AS_WELL} {len(cause.failed)}</summary>{rows}</details>"
    if cause.unnamed:
        titles = "".join(f"<li>{html.escape(title)}</li>" for title in cause.unnamed)
        return f"{row}<details {INDENT}><summary>{cause.not_checked}</summary><ul>{titles}</ul></details>"
    return row + (f"<div {INDENT}>{html.escape(cause.not_checked)}</div>" if cause.not_checked else "")


def _row_html(line: CheckResult) -> str:
    # The colour is beside the words, because no text colour is readable on both white and black.
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
