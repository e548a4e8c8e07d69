"""`autograder notebooks`: executes the course's notebooks."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from autograder import course_paths
from autograder.cli.options import jobs_option, json_option
from autograder.cli.terminal import echo
from autograder.result.model import write_json

if TYPE_CHECKING:
    from autograder.author.course.execute import Execution


@click.command()
@click.argument("assignments", nargs=-1, metavar="[ID]...")
@click.option("--source", is_flag=True, help="Execute the source notebooks in chapters/ (default).")
@click.option("--solved", is_flag=True, help="Execute them with the reference answers.")
@click.option("--released", is_flag=True, help="Execute them as students get them, with unsolved exercises.")
@jobs_option
@json_option
def notebooks(
    assignments: tuple[str, ...], source: bool, solved: bool, released: bool, jobs: int, json_file: Path | None
) -> None:
    """Execute the notebooks of the chapters ID (all by default).

    Warnings are errors. The report of each notebook is in .build/notebooks. The forms can be combined: --source
    --solved --released executes all three.
    """
    from autograder.author.course.execute import run_notebook
    from autograder.author.course.forms import Form
    from autograder.author.course.sync import Chapter, chapters
    from autograder.grade.parallel import map_parallel
    from autograder.ros import activate

    activate()
    requested_forms = {Form.SOURCE: source, Form.SOLVED: solved, Form.RELEASED: released}
    forms = [form for form, is_requested in requested_forms.items() if is_requested] or [Form.SOURCE]
    to_run = [(chapter, form) for form in forms for chapter in chapters(assignments)]

    def run(chapter_and_form: tuple[Chapter, Form]) -> Execution:
        chapter, form = chapter_and_form
        report = course_paths.BUILD / "notebooks" / f"{chapter.assignment}-{form.value}.ipynb"
        return run_notebook(chapter, form, report=report)

    runs = map_parallel(run, to_run, jobs=jobs, on_done=_print_result)
    if json_file is not None:
        write_json(
            json_file,
            [
                {"assignment": run.chapter, "form": run.form.value, "seconds": run.seconds, "failure": run.failure}
                for run in runs
            ],
        )
    sys.exit(0 if all(run.ok for run in runs) else 1)


def _print_result(run: Execution) -> None:
    echo(f"{run.chapter} ({run.form.value}): {'ok' if run.ok else 'failed'} in {run.seconds:.1f} s")
    if run.failure is not None:
        echo(run.failure)
