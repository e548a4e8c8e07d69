"""A class of five hands in each chapter. nbgrader's gradebook agrees with `autograder grade`, run with one job and two.

Correct, flawed and missing answers are files; a student submits them as a notebook that writes them. `make classes`
and `make nightly` take every chapter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pytest

from autograder.author.course.sync import Chapter
from autograder.author.verification.cases import cases
from autograder.author.verification.mutants import Mutant, mutants, write_mutant
from autograder.author.verification.verdicts import CaseKind, verify_mutant, verify_zero
from autograder.course_paths import chapter
from autograder.report.export import load
from autograder.result.model import Result
from autograder.suite import suites
from tests.e2e.classroom import Classroom

pytestmark = [
    pytest.mark.slow,
    pytest.mark.nightly,
    pytest.mark.timeout(3600),  # a quarter of an hour on a busy machine; the bound is for a stuck grader
    # What nbgrader does with SQLAlchemy.
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]

Verifier = Callable[[Result], str]


@dataclass(frozen=True)
class Pupil:
    """A student: the answer in the notebook (None if there is none), and the expected result."""

    name: str
    write: Callable[[Path], None] | None
    verify: Verifier


@dataclass(frozen=True)
class Graded:
    """A class after grading: its classroom, its students, and the results with one and with two parallel jobs."""

    room: Classroom
    pupils: tuple[Pupil, ...]
    serial: dict[str, Result]
    parallel: dict[str, Result]


def pupils(assignment: str) -> Iterator[Pupil]:
    """Yield the class: the reference, the right answers of another style, two mutants, and an untouched notebook."""
    for case in cases(assignment, quick=True):
        if case.kind in (CaseKind.REFERENCE, CaseKind.VARIANT):
            yield Pupil(case.name, case.write, case.verify)
    for mutant in two_mutants(assignment):
        write = partial(write_mutant, mutant, suites.hidden(assignment).sources)
        yield Pupil(mutant.id, write, partial(verify_mutant, mutant))
    yield Pupil("untouched", None, verify_zero)


def two_mutants(assignment: str) -> list[Mutant]:
    """Return two mutants: if possible, one whose files all have cells in the notebook, and one with other files."""
    heads = {cell.source.partition("\n")[0] for cell in Chapter(chapter(assignment)).read().cells}
    quick = [mutant for mutant in mutants(assignment) if not mutant.slow]
    inside = [m for m in quick if all(edit.replace and f"%%writefile ws/src/{edit.file}" in heads for edit in m.edits)]
    outside = [mutant for mutant in quick if mutant not in inside]
    return [*inside[:1], *outside[:1], *inside[1:], *outside[1:]][:2]


@pytest.fixture(scope="module", params=suites.graded_assignments())
def assignment(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def graded(assignment: str, tmp_path_factory: pytest.TempPathFactory) -> Graded:
    """The class of an assignment after both ways to grade it."""
    place = tmp_path_factory.mktemp(assignment)
    room, everybody = Classroom(place / "class", assignment), tuple(pupils(assignment))
    room.nbgrader("generate_assignment")
    for pupil in everybody:
        if pupil.write is None:
            room.hand_in(pupil.name)
        else:
            pupil.write(place / "answers" / pupil.name)
            room.hand_in(pupil.name, place / "answers" / pupil.name)
    room.nbgrader("autograde")
    parallel = room.grade("-j", "2")
    return Graded(
        room,
        everybody,
        {result.student: result for result in load(room.course / ".build" / "nbgrader" / assignment)},
        {result.student: result for result in load(parallel)},
    )


def test_each_submission_gets_its_expected_mark(graded: Graded) -> None:
    assert len(graded.pupils) >= 4
    wrong = {pupil.name: pupil.verify(graded.serial[pupil.name]) for pupil in graded.pupils}
    assert set(wrong.values()) == {""}, wrong


def test_the_gradebook_has_the_points_that_the_grader_gave(graded: Graded, assignment: str) -> None:
    groups = suites.hidden(assignment).groups
    for pupil in graded.pupils:
        result = graded.parallel[pupil.name]
        grades = graded.room.grades(pupil.name)
        # A question that a person grades has no points if the student wrote nothing. Otherwise it waits for a person.
        recorded = {name: (score, worth) for name, (score, worth, _) in grades.items() if name.startswith("grade-")}
        assert all(by_hand or not score for name, (score, _, by_hand) in grades.items() if name not in recorded)
        expected = {
            f"grade-{name.replace('_', '-')}": (
                pytest.approx(sum(check.points for check in result.group(name))),
                pytest.approx(worth),
            )
            for name, worth in groups.items()
        }
        assert recorded == expected, pupil.name
        assert sum(worth for _, worth in recorded.values()) == pytest.approx(result.max_score)


def test_two_gradings_at_once_give_the_same_results_as_one_after_the_other(graded: Graded) -> None:
    def marks(results: dict[str, Result]) -> dict[str, list[tuple[str, str, float]]]:
        return {
            student: [(check.id, check.outcome.value, check.points) for check in result.checks]
            for student, result in results.items()
        }

    assert set(graded.serial) == {pupil.name for pupil in graded.pupils}
    assert marks(graded.parallel) == marks(graded.serial)
