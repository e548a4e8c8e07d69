"""Runs the visible checks on a submission, with the same results as `check(...)` on the same files."""

from __future__ import annotations

import json
import logging
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from autograder.diagnosis import OK
from autograder.exceptions import GraderError, UsageError
from autograder.notebook.worker_client import run_on
from autograder.plain_text import visible
from autograder.result.model import CheckResult, structure, write_json
from autograder.run.sandbox import Isolation

LOG = logging.getLogger(__name__)
FILE = "visible.json"  # beside the result
COULD_NOT_RUN_SENTENCE = "The visible checks could not be run here. Run check(...) in the notebook."
NOT_RUN_SENTENCE = "The visible checks were not run on this answer. Run check(...) in the notebook."


@dataclass(frozen=True)
class VisibleReport:
    """The results of the visible checks."""

    sentence: str  # why they could not run, or why packages were not built; empty otherwise
    checks: tuple[CheckResult, ...] = ()


def run_visible(answer: Path, assignment: str, isolation: Isolation) -> VisibleReport:
    """Run the visible checks on an answer in a worker sandbox, and log an error if they cannot be run."""
    try:
        all_checks: dict[str, Any] = {"exercises": (), "part": "", "first": ()}
        with run_on(answer.resolve(), isolation, "check", assignment=assignment, **all_checks) as (reply, _):
            diagnosis, checks = reply["diagnosis"], reply["checks"]
    except GraderError as error:
        LOG.error("The visible checks of %s: %s", assignment, visible(str(error)))
        return VisibleReport(COULD_NOT_RUN_SENTENCE)
    sentence = "" if diagnosis["kind"] == OK.kind.value else diagnosis["sentence"]
    return VisibleReport(sentence, tuple(structure(CheckResult, check) for check in checks))


def write(report: VisibleReport, folder: Path) -> None:
    """Write a report to the folder of a result."""
    write_json(folder / FILE, asdict(report))


def read(folder: Path) -> VisibleReport:
    """Read the report in the folder of a result. Raises UsageError if it cannot be read."""
    try:
        report: VisibleReport = structure(VisibleReport, json.loads((folder / FILE).read_text(encoding="utf-8")))
    except FileNotFoundError:  # it was graded with other settings
        return VisibleReport(NOT_RUN_SENTENCE)
    except (ValueError, TypeError, KeyError) as error:
        raise UsageError(f"{folder / FILE}: cannot be read: {error}") from None
    return report
