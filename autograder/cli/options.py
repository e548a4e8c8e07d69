"""Options that several verbs share, and how a table looks on a terminal."""

from __future__ import annotations

import math
import os
import shutil
import textwrap
from pathlib import Path

import click

from autograder.checks import Outcome
from autograder.grading import DEFAULT_SEED
from autograder.result import Result, Status
from autograder.sandbox import Tier

json_option = click.option(
    "--json", "json_file", type=click.Path(path_type=Path, dir_okay=False), help="Also write what was found as JSON."
)
jobs_option = click.option(
    "-j",
    "--jobs",
    type=click.IntRange(1, 64),
    default=os.cpu_count() or 1,
    show_default=True,
    help="The number of workers.",
)
seed_option = click.option(
    "--seed",
    type=click.IntRange(0, 2**31 - 1),
    default=DEFAULT_SEED,
    show_default=True,
    help="The number from which hidden inputs are drawn.",
)
isolation_option = click.option(
    "--isolation",
    type=click.Choice([tier.value for tier in Tier]),
    default=Tier.BUBBLEWRAP.value,
    show_default=True,
    help="How submissions are kept apart. Use `process` only for code that you trust.",
)


def reason(result: Result) -> str:
    """Say in one sentence why a result is not full: what a picture shows comes before what only words say."""
    if result.status is Status.NOT_GRADED or result.build is None or not result.build.ok:
        return result.diagnosis.sentence
    failed = [check for check in result.checks if check.outcome is Outcome.FAILED]
    pictured = {artifact.check for artifact in result.artifacts}
    failed.sort(key=lambda check: check.id not in pictured)
    more = f" (and {len(failed) - 1} more)" if len(failed) > 1 else ""
    return f"{failed[0].message}{more}" if failed else ""


def table(rows: list[tuple[str, str, str]], headings: tuple[str, str, str]) -> str:
    """Return a table of three columns; the last one is wrapped."""
    first = max(len(row[0]) for row in [headings, *rows])
    second = max(len(row[1]) for row in [headings, *rows])
    width = max(40, shutil.get_terminal_size((120, 24)).columns - first - second - 4)
    lines = []
    for index, (name, mark, text) in enumerate([headings, *rows]):
        wrapped = textwrap.wrap(text, width) or [""]
        lines.append(f"{name:<{first}}  {mark:>{second}}  {wrapped[0]}".rstrip())
        lines += [" " * (first + second + 4) + line for line in wrapped[1:]]
        if index == 0:
            lines.append("-" * (first + second + 4 + min(width, 60)))
    return "\n".join(lines)


def marks(result: Result) -> str:
    """Return a result's marks as text; one that was not graded has none."""
    if result.status is Status.NOT_GRADED:
        return "not graded"
    return f"{result.score:g}/{result.max_score:g} = {math.floor(result.percent)} %"  # never rounded up to all
