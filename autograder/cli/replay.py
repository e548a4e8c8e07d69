"""`autograder replay`: shows one check of a stored result, with its run in the player."""

from __future__ import annotations

import os
import shutil
import tempfile
import webbrowser
from collections.abc import Iterator
from pathlib import Path

import click

from autograder.cli.options import isolation_option
from autograder.cli.terminal import echo
from autograder.exceptions import UsageError
from autograder.grade.job import Job, Scope
from autograder.grade.pipeline import grade_submission
from autograder.report import feedback
from autograder.report.export.stored import load
from autograder.result.model import Result, Status
from autograder.run.sandbox import Tier
from autograder.suite import suites


@click.command()
@click.argument("stored", metavar="RESULT", type=click.Path(path_type=Path))
@click.option("--check", required=True, metavar="ID", help="The check to show; its id is in result.json.")
@click.option(
    "--submission",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="What was handed in: it is graded again, with the result's seed. Without it, the run that was kept is shown.",
)
@click.option(
    "--mcap", is_flag=True, help="With --submission: also write the topics of the run, for Foxglove and `ros2 bag`."
)
@click.option(
    "--open/--no-open", "show", default=None, help="Open the page in a browser; the default where there is a display."
)
@isolation_option
def replay(stored: Path, check: str, submission: Path | None, mcap: bool, show: bool | None, isolation: str) -> None:
    """Show the check ID of the result at RESULT: what it says, and the run that it judged, in the player.

    RESULT is a result.json, or the folder of one student's result. The page is written to the folder replay/ID beside
    it. The exit status is 0 when there is a page, 1 when the submission could not be graded, and 2 for a wrong call.
    """
    if mcap and submission is None:
        raise UsageError("--mcap needs --submission PATH: the kept run has no messages, they come from a new grading")
    found = _one(stored)
    if check not in {each.id for each in found.checks}:
        known = ", ".join(each.id for each in found.checks)
        raise UsageError(f"{stored}: the result has no check {check!r}; it has: {known}")
    folder = found.folder / "replay" / check
    with tempfile.TemporaryDirectory(prefix="replay-") as scratch:
        if submission is not None:
            found = _grade_again(found, check, submission, Path(scratch), Tier(isolation), mcap)
        result = found.only(check) if found.status is Status.GRADED else found
        page = feedback.write(result, folder, artifacts=result.folder)
        echo(f"The run of {check!r}: {page}")
        for bag in _bags(Path(scratch), folder):
            echo(f"Its messages: {bag}")
    if show if show is not None else bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        webbrowser.open(page.resolve().as_uri())


def _one(path: Path) -> Result:
    found = load(path)
    if len(found) != 1:
        raise UsageError(f"{path}: holds {len(found)} results; give the folder of one student")
    return found[0]


def _grade_again(result: Result, check: str, submission: Path, out: Path, tier: Tier, recordings: bool) -> Result:
    """Grade a check, and those that it needs, once more with the seed of its result."""
    scope = Scope(only=suites.hidden(result.assignment).with_dependencies(check), recordings=recordings)
    graded = grade_submission(Job(submission, result.assignment, result.student, result.seed, out, tier, scope))
    if graded.status is Status.GRADED and graded.submission_sha256 != result.submission_sha256:
        echo(f"Note: {submission} is not what was graded then; the run may differ.", err=True)
    return graded


def _bags(recordings: Path, out: Path) -> Iterator[Path]:
    from sim.export import to_mcap
    from sim.recording import load_recording

    for path in sorted(recordings.glob("*.npz")):
        bag = out / path.stem
        if bag.exists():
            shutil.rmtree(bag)  # of the replay before this one
        yield to_mcap(load_recording(path), bag)
