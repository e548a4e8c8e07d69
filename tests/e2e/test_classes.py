"""Classes of five students submit each chapter. nbgrader's gradebook must agree with `autograder grade -j 2`.

Correct, flawed and missing answers are files. A student submits a notebook that writes them. `make classes` and `make
nightly` run these tests.
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
    pytest.mark.timeout(3600),  # takes 15 minutes on a busy machine; the limit ends a grader that hangs
    # nbgrader's use of SQLAlchemy.
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
    """A class after grading: its classroom, its students, and its results from nbgrader and from two parallel jobs."""

    room: Classroom
    pupils: tuple[Pupil, ...]
    serial: dict[str, Result]
    parallel: dict[str, Result]


def pupils(assignment: str) -> Iterator[Pupil]:
    """Yield the class: the reference, the correct answers in another style, two mutants, and an untouched notebook."""
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
    in_cells = [
        m for m in quick if all(edit.replace and f"%%writefile ws/src/{edit.file}" in heads for edit in m.edits)
    ]
    in_other_files = [mutant for mutant in quick if mutant not in in_cells]
    return [*in_cells[:1], *in_other_files[:1], *in_cells[1:], *in_other_files[1:]][:2]


@pytest.fixture(scope="module", params=suites.graded_assignments())
def assignment(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def graded(assignment: str, tmp_path_factory: pytest.TempPathFactory) -> Graded:
    """The class of an assignment, graded by nbgrader and by `autograder grade -j 2`."""
    folder = tmp_path_factory.mktemp(assignment)
    room, students = Classroom(folder / "class", assignment), tuple(pupils(assignment))
    room.nbgrader("generate_assignment")
    for pupil in students:
        if pupil.write is None:
            room.hand_in(pupil.name)
        else:
            pupil.write(folder / "answers" / pupil.name)
            room.hand_in(pupil.name, folder / "answers" / pupil.name)
    room.nbgrader("autograde")
    parallel = room.grade("-j", "2")
    return Graded(
        room,
        students,
        {result.student: result for result in load(room.course / ".build" / "nbgrader" / assignment)},
        {result.student: result for result in load(parallel)},
    )


def test_each_submission_gets_its_expected_mark(graded: Graded) -> None:
    assert len(graded.pupils) >= 4
    problems = {pupil.name: pupil.verify(graded.serial[pupil.name]) for pupil in graded.pupils}
    assert set(problems.values()) == {""}, problems


def test_the_gradebook_has_the_points_that_the_grader_gave(graded: Graded, assignment: str) -> None:
    groups = suites.hidden(assignment).groups
    for pupil in graded.pupils:
        result = graded.parallel[pupil.name]
        grades = graded.room.grades(pupil.name)
        # A question for manual grading waits for its grade, or has no points because the student wrote nothing.
        scores = {name: score for name, (score, _, _) in grades.items() if name.startswith("grade-")}
        worths = {name: worth for name, (_, worth, _) in grades.items() if name.startswith("grade-")}
        assert all(by_hand or not score for name, (score, _, by_hand) in grades.items() if name not in scores)
        cells = {name: f"grade-{name.replace('_', '-')}" for name in groups}
        points = {cell: sum(check.points for check in result.group(name)) for name, cell in cells.items()}
        assert scores == pytest.approx(points), pupil.name
        assert worths == pytest.approx({cell: groups[name] for name, cell in cells.items()}), pupil.name
        assert sum(worths.values()) == pytest.approx(result.max_score)


def test_parallel_gradings_give_the_same_results_as_serial_ones(graded: Graded) -> None:
    def marks(results: dict[str, Result]) -> dict[str, list[tuple[str, str, float]]]:
        return {
            student: [(check.id, check.outcome.value, check.points) for check in result.checks]
            for student, result in results.items()
        }

    assert set(graded.serial) == {pupil.name for pupil in graded.pupils}
    assert marks(graded.parallel) == marks(graded.serial)
