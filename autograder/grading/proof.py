"""The proof of a suite: the reference has every point, the untouched release none, each mutant loses what it names."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from autograder import layout, suites
from autograder.checks import Outcome
from autograder.diagnosis import Kind
from autograder.grading.batch import Entry, grade_all
from autograder.result import Result, Status
from autograder.sandbox import Tier
from autograder.suites.mutants import Mutant, lay_down, lay_down_reference, mutants

REFERENCE, RELEASE = "reference", "release"


@dataclass(frozen=True)
class Claim:
    """What grading one submission of the proof must show, and whether it did.

    Attributes:
        name: `reference`, `release` or a mutant's id.
        result: what grading gave.
        wrong: what is not as claimed, in words; empty when the claim holds.
    """

    name: str
    result: Result
    wrong: str

    @property
    def holds(self) -> bool:
        """Whether the grader did what it must."""
        return not self.wrong


def prove(
    assignment: str,
    *,
    seed: int,
    out: Path,
    jobs: int,
    isolation: Tier = Tier.BUBBLEWRAP,
    only: Callable[[Mutant], bool] = lambda mutant: True,
    on_result: Callable[[Result], None] = lambda result: None,
) -> tuple[Claim, ...]:
    """Grade the reference, the release and mutants of an assignment, and judge the grader by them.

    Args:
        assignment: whose suite is proved.
        seed: every hidden input is drawn from it.
        out: gets each submission's result.
        jobs: how many are graded at once.
        isolation: the sandbox's tier.
        only: picks the mutants.
        on_result: called for each result as it comes.
    """
    suite = suites.load(assignment)
    chosen = [mutant for mutant in mutants(assignment) if only(mutant)]
    with tempfile.TemporaryDirectory(prefix="proof-") as name:
        folder = Path(name)
        lay_down_reference(suite.packages, folder / REFERENCE)
        _lay_down_release(assignment, folder / RELEASE)
        for mutant in chosen:
            lay_down(mutant, suite.packages, folder / mutant.id)
        names = [REFERENCE, RELEASE, *(mutant.id for mutant in chosen)]
        entries = tuple(Entry(name, folder / name) for name in names)
        results = grade_all(
            entries, assignment, seed=seed, out=out, jobs=jobs, isolation=isolation, on_result=on_result
        )
    reference, release, *flawed = results
    return (
        Claim(REFERENCE, reference, _not_full(reference)),
        Claim(RELEASE, release, "" if _graded(release) and release.score == 0 else f"it scores {release.score:g}"),
        *(Claim(mutant.id, result, judge(mutant, result)) for mutant, result in zip(chosen, flawed, strict=True)),
    )


def judge(mutant: Mutant, result: Result) -> str:
    """Say where a mutant's result differs from what the mutant claims; an empty string if nowhere."""
    if not _graded(result):
        return result.diagnosis.sentence
    lost = {check.id for check in result.checks if check.outcome is not Outcome.PASSED}
    wrong = [f"also loses {', '.join(sorted(lost - mutant.loses))}"] if lost - mutant.loses else []
    wrong += [f"keeps {', '.join(sorted(mutant.loses - lost))}"] if mutant.loses - lost else []
    if result.diagnosis.kind is not mutant.diagnosis:
        wrong.append(f"is diagnosed {result.diagnosis.kind.value} instead of {mutant.diagnosis.value}")
    return "; ".join(wrong)


def _lay_down_release(assignment: str, folder: Path) -> None:
    """Write the assignment's folder as students get it."""
    import nbformat

    from autograder.course import Chapter, Form, in_form
    from autograder.course.execute import NOT_COPIED

    chapter = Chapter(layout.chapter(assignment))
    shutil.copytree(chapter.folder, folder, ignore=NOT_COPIED)
    nbformat.write(in_form(chapter.read(), Form.RELEASED), folder / chapter.path.name)


def _graded(result: Result) -> bool:
    return result.status is Status.GRADED


def _not_full(result: Result) -> str:
    if not _graded(result) or result.diagnosis.kind is not Kind.OK:
        return result.diagnosis.sentence
    lost = [check.id for check in result.checks if check.outcome is not Outcome.PASSED]
    return f"loses {', '.join(lost)}" if lost else ""
