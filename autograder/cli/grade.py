"""`autograder grade`: grades submissions."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import click

from autograder.cli.compare import print_changes
from autograder.cli.options import isolation_option, jobs_option, json_option, seed_option
from autograder.cli.submissions import find_submissions, roster_option
from autograder.cli.terminal import INTERRUPTED, echo, on_line
from autograder.cli.text_tables import failure_summary, score_text, table
from autograder.exceptions import StudentError, UsageError
from autograder.grade.batch import GradeJobs, grade_all, stored_result
from autograder.grade.isolated_reader import read_preview
from autograder.grade.job import Job
from autograder.grade.store import LOG, RESULT
from autograder.report import feedback
from autograder.report.export import load
from autograder.report.export.earlier_marks import EarlierMarks
from autograder.result.model import Result, Status, write_json
from autograder.run.sandbox import Isolation
from autograder.suite import suites


@click.command()
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--assignment", required=True, metavar="ID", help="The assignment of the submissions.")
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("results"),
    show_default=True,
    help="The folder for the results. Each student gets a subfolder with result.json, pictures and feedback.html.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Keep results whose submission, suite, seed and isolation level are unchanged. List changed marks.",
)
@roster_option
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Grade on the workers of this Dask scheduler: tls://HOST:8786, or `local` for -j workers on this machine.",
)
@click.option(
    "--certificates",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("cluster-certificates"),
    show_default=True,
    help="The folder with the cluster's certificate and key.",
)
@click.option(
    "--dry-run",
    is_flag=True,
    help="Do not grade. List the files of each submission that would be graded, and those that are not used.",
)
@jobs_option
@seed_option
@isolation_option
@json_option
def grade(
    paths: tuple[Path, ...],
    assignment: str,
    out: Path,
    resume: bool,
    roster: Path | None,
    scheduler: str | None,
    certificates: Path,
    dry_run: bool,
    jobs: int,
    seed: int,
    isolation: str,
    json_file: Path | None,
) -> None:
    """Grade the submissions at PATHS.

    A path is a submission (a folder, a zip, a tar or a notebook), or a folder with a submission for each student.

    The exit status is 0 if every submission was graded, 1 if one was not graded, is unclear or matches no student in
    --roster, 2 for wrong usage, and 130 after Ctrl-C. Ctrl-C lets the gradings in progress finish.
    """
    suites.hidden(assignment)
    if dry_run:
        with find_submissions(paths, assignment, roster) as (submissions, all_match):
            preview_jobs = [
                Job(path, assignment, name, seed, out / name, Isolation(isolation))
                for name, path in submissions.items()
            ]
            sys.exit(0 if _print_preview(preview_jobs, resume) and all_match else 1)
    with (
        find_submissions(paths, assignment, roster, out=out) as (submissions, all_match),
        Progress(len(submissions)) as progress,
    ):
        earlier_marks = EarlierMarks(out, submissions)
        try:
            with _cluster_grader(scheduler, jobs, certificates) as grade_jobs:
                results = grade_all(
                    submissions,
                    assignment,
                    seed=seed,
                    out=out,
                    jobs=jobs,
                    isolation=Isolation(isolation),
                    resume=resume,
                    on_result=progress.show,
                    grade_jobs=grade_jobs,
                )
        except KeyboardInterrupt:
            message = f"Stopped. Finished results are in {out}: the same command with --resume grades the rest."
            echo(f"\n{message}", err=True)
            sys.exit(INTERRUPTED)
    report(results, out, json_file)
    if resume and (changed_marks := earlier_marks.changed(results)):
        echo("\nMarks that changed because of the suite or the submission:")
        print_changes(changed_marks)
    earlier_marks.forget(results)
    sys.exit(0 if all_match and all(result.status is Status.GRADED for result in results) else 1)


def report(results: Sequence[Result], out: Path, json_file: Path | None) -> None:
    """Write the feedback of a class, print a table of its marks, and write the results as JSON."""
    for result in results:
        feedback.write(result, out / result.student)
    summary = feedback.write_summary(results, out)
    echo(
        "\n" + table([(r.student, score_text(r), failure_summary(r)) for r in results], ("submission", "marks", "why"))
    )
    for result in results:
        for note in filter(None, (*result.notices, _unused_note(result.unused))):
            echo(f"{on_line(result.student)}: {on_line(note)}")
    for result in results:
        if result.status is Status.UNCLEAR:
            echo(f"Unclear: {on_line(result.student)}: {on_line(result.diagnosis.sentence)}", err=True)
    echo(f"\nFeedback: {summary}")
    for result in results:
        if result.unjudged:
            checks, log = ", ".join(result.unjudged), out / result.student / LOG
            warning = f"{checks} failed because the check raised an error: see {on_line(log)}."
            echo(f"{on_line(result.student)}: {warning}", err=True)
    if json_file is not None:
        write_json(json_file, [result.to_json() for result in results])


def _print_preview(jobs: Sequence[Job], resume: bool) -> bool:
    """Print which files of each submission would be graded, and what would happen to its stored result.

    Returns:
        Whether it is clear for every submission which files to grade.
    """
    rows, all_clear = [], True
    for job in jobs:
        effect = _describe_effect(job, resume)
        try:
            preview = read_preview(job.path, job.assignment, job.isolation)
        except StudentError as error:
            rows.append((job.student, effect, "unclear", on_line(str(error))))
            all_clear = False
            continue
        files = "the notebook has to run" if preview.files is None else f"{preview.files} files are graded"
        rows.append((job.student, effect, files, on_line(" ".join((*preview.notices, _unused_note(preview.unused))))))
    echo(table(rows, ("submission", "result", "status", "notes")))
    echo("Nothing was graded or written.")
    return all_clear


def _describe_effect(job: Job, resume: bool) -> str:
    """Describe what grading would do to the stored result."""
    file = job.out / RESULT
    if not file.is_file():
        return "new"
    if resume and (reusable := stored_result(job)) is not None:
        return f"keeps {score_text(reusable)}"
    try:
        (previous,) = load(file)
    except (UsageError, ValueError):
        return "replaces one that cannot be read"
    return f"replaces {score_text(previous)}"


def _unused_note(names: Sequence[str]) -> str:
    return f"Not used: {', '.join(names)}." if names else ""


@contextmanager
def _cluster_grader(scheduler: str | None, jobs: int, certificates: Path) -> Iterator[GradeJobs | None]:
    """Yield the function that grades on a cluster, or None if submissions are graded on this machine."""
    if scheduler is None:
        yield None
        return
    try:
        from autograder.grade.cluster.connection import connected
        from autograder.grade.cluster.dispatch import grade_on
    except ModuleNotFoundError as error:
        if error.name not in ("distributed", "msgpack"):
            raise
        raise UsageError("--scheduler needs Dask, which is not installed here: run `make cluster`") from None
    with connected(scheduler, jobs, certificates) as client:
        yield partial(grade_on, client, report=partial(echo, err=True))


class Progress:
    """A progress bar on a terminal, or a line of text for each submission elsewhere."""

    def __init__(self, total: int) -> None:
        self._total, self._plain = total, not sys.stdout.isatty()
        self._bar = click.progressbar(length=total, label="grading", hidden=self._plain)

    def __enter__(self) -> Progress:
        self._bar.__enter__()
        return self

    def __exit__(self, *error: object) -> None:
        self._bar.render_finish()

    def show(self, result: Result, name: str = "", marks: str = "") -> None:
        """Count another result. If lines are printed, they show `name` (or the student) and `marks` (or the score)."""
        self._bar.update(1)
        if self._plain:
            echo(f"[{self._bar.pos}/{self._total}] {on_line(name or result.student)}: {marks or score_text(result)}")
