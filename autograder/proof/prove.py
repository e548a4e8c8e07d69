"""Grading the submissions of the proof, and judging the grader by them."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from autograder.grading.batch import Entry, grade_all
from autograder.grading.lanes import Lanes
from autograder.proof.cases import Case
from autograder.proof.claims import Claim
from autograder.result import Result
from autograder.sandbox import Tier

SUBMISSION = "submission"


def prove(
    assignment: str,
    cases: Sequence[Case],
    *,
    seed: int,
    out: Path,
    jobs: int,
    isolation: Tier = Tier.BUBBLEWRAP,
    on_result: Callable[[Result], None] = lambda result: None,
) -> tuple[Claim, ...]:
    """Grade the submissions of a proof.

    Args:
        assignment: whose suite is proved.
        cases: from `cases`.
        seed: every hidden input is drawn from it.
        out: gets each submission's result.
        jobs: how many are graded at once.
        isolation: the sandbox's tier.
        on_result: called for each result as it comes.
    """
    with tempfile.TemporaryDirectory(prefix="proof-") as name:
        entries = tuple(Entry(case.name, _written(case, Path(name) / case.name), case.scope) for case in cases)
        with Lanes(assignment, isolation, jobs) as lanes:
            results = grade_all(
                entries,
                assignment,
                seed=seed,
                out=out,
                jobs=jobs,
                isolation=isolation,
                run_job=lanes,
                on_result=on_result,
            )
    return tuple(
        Claim(assignment, case.kind, case.name, result, case.judge(result), case.reason)
        for case, result in zip(cases, results, strict=True)
    )


def _written(case: Case, folder: Path) -> Path:
    """Write a case; return where its submission lies."""
    case.write(folder)
    return folder / SUBMISSION if (folder / SUBMISSION).is_dir() else folder
