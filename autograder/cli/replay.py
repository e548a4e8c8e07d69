"""`autograder replay`: shows a check of a stored result, with its run in the player."""

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
from autograder.grade.job import Job, Options
from autograder.grade.pipeline import grade_submission
from autograder.report import feedback
from autograder.report.export.stored import load
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation
from autograder.suite import suites


@click.command()
@click.argument("stored", metavar="RESULT", type=click.Path(path_type=Path))
@click.option("--check", required=True, metavar="ID", help="The check to show; its id is in result.json.")
@click.option(
    "--submission",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="The submission, to be graded again with the result's seed. The default is to show the stored run.",
)
@click.option(
    "--mcap", is_flag=True, help="With --submission: also write the run's topics, for Foxglove and `ros2 bag`."
)
@click.option(
    "--open/--no-open", "open_page", default=None, help="Open the page in a browser (default if there is a display)."
)
@isolation_option
def replay(
    stored: Path, check: str, submission: Path | None, mcap: bool, open_page: bool | None, isolation: str
) -> None:
    """Show the check ID of the result at RESULT: its message, and its run in the player.

    RESULT is a result.json, or the folder of one student's result. The page is written to the folder replay/ID beside
    it. The exit status is 0 if the page was written, 1 if the submission could not be graded, and 2 for wrong usage.
    """
    if mcap and submission is None:
        raise UsageError("--mcap needs --submission PATH: the stored run has no messages, only a new grading has")
    original = _single_result(stored)
    if check not in {result_check.id for result_check in original.checks}:
        known_checks = ", ".join(result_check.id for result_check in original.checks)
        raise UsageError(f"{stored}: the result has no check {check!r}; it has: {known_checks}")
    folder = original.folder / "replay" / check
    with tempfile.TemporaryDirectory(prefix="replay-") as scratch:
        full_result = original
        if submission is not None:
            full_result = _grade_again(original, check, submission, Path(scratch), Isolation(isolation), mcap)
        result = full_result.only(check) if full_result.status is Status.GRADED else full_result
        page = feedback.write(result, folder, artifacts=result.folder)
        echo(f"The run of {check!r}: {page}")
        for bag in _bags(Path(scratch), folder):
            echo(f"Its messages: {bag}")
    has_display = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    if has_display if open_page is None else open_page:
        webbrowser.open(page.resolve().as_uri())


def _single_result(path: Path) -> Result:
    results = load(path)
    if len(results) != 1:
        raise UsageError(f"{path} contains {len(results)} results; use the folder of one student")
    return results[0]


def _grade_again(
    result: Result, check: str, submission: Path, out: Path, isolation: Isolation, recordings: bool
) -> Result:
    """Grade a check and its dependencies again with the seed of its result."""
    options = Options(only=suites.hidden(result.assignment).with_dependencies(check), recordings=recordings)
    new_result = grade_submission(
        Job(submission, result.assignment, result.student, result.seed, out, isolation, options)
    )
    if new_result.status is Status.GRADED and new_result.submission_sha256 != result.submission_sha256:
        echo(f"Note: {submission} differs from the graded submission, so the run may differ.", err=True)
    return new_result


def _bags(recordings: Path, out: Path) -> Iterator[Path]:
    from sim.export import to_mcap
    from sim.recording import load_recording

    for path in sorted(recordings.glob("*.npz")):
        bag = out / path.stem
        if bag.exists():
            shutil.rmtree(bag)  # the bag of an earlier replay
        yield to_mcap(load_recording(path), bag)
