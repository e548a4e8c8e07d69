"""The service is killed at any instant, and started again: each answer has one mark, and none is lost.

An instant is a line of the service's own code, in any thread. Students keep handing in, and repeat a hand-in with the
same key if no reply came.
"""

from __future__ import annotations

from pathlib import Path
from threading import Thread

import pytest

from autograder.grade.store import RESULT
from autograder.lms.serve.store import Store
from autograder.notebook.handing_in import Receipt
from autograder.result.model import Status
from tests.answers import zipped
from tests.unit.serve.classroom import FORKS, Classroom
from tests.unit.serve.serving import ORDER

CLASS = ("ada", "bob", "ada", "cleo")  # the students, in the order of their hand-ins
INSTANTS = 20
LINES = 950  # of the service's code from its start to the last grading, at least; the test below counts them
QUICK = (1, 7, 13, 19)  # the instants of a quick run


class Class(Thread):
    """Students who hand in one after the other, whatever happens to the service."""

    def __init__(self, classroom: Classroom) -> None:
        super().__init__(daemon=True)
        self._classroom = classroom
        self.receipts: list[Receipt] = []

    def run(self) -> None:
        for number, student in enumerate(CLASS):
            answer = zipped({"src/package/package.xml": f"{student} {number}".encode()})
            self.receipts.append(self._classroom.hand_in(student, answer))


def marks_in(folder: Path) -> dict[int, tuple[str, float]]:
    """Return the students and points in the store, by number. Each hand-in must have a result."""
    store = Store(folder)
    try:
        hand_ins = {entry.number: entry for entry in store.of_assignment("02_nodes")}
        assert all(entry.mark is not None and entry.mark.status is Status.GRADED for entry in hand_ins.values())
        assert all((store.folder(number) / RESULT).is_file() for number in hand_ins)
        return {
            number: (entry.student, entry.mark.points) for number, entry in hand_ins.items() if entry.mark is not None
        }
    finally:
        store.close()


def test_a_class_runs_more_lines_than_the_instants_are_spread_over(classroom: Classroom) -> None:
    lines = FORKS.Value("L", 0)
    classroom.start(lines=lines)
    Class(classroom).run()
    order = classroom.folder / ORDER  # a request for a page would run lines, too
    classroom.wait(lambda: order.exists() and len(order.read_text().split()) == len(CLASS))
    assert lines.value > LINES


@pytest.mark.parametrize(
    "instant", [pytest.param(index, marks=() if index in QUICK else pytest.mark.nightly) for index in range(INSTANTS)]
)
def test_a_kill_at_any_instant_loses_nothing_and_grades_nothing_twice(classroom: Classroom, instant: int) -> None:
    for student in (*CLASS, "grace"):
        classroom.hub.token(student)
    lines, more_lines = (FORKS.Value("L", 0) for _ in range(2))
    classroom.start(lines=lines, kill_at=instant * LINES // INSTANTS)
    students = Class(classroom)
    students.start()
    classroom.wait_for_the_kill()
    classroom.start(lines=more_lines, kill_at=(INSTANTS - instant) * LINES // INSTANTS // 2)
    classroom.wait_for_the_kill()
    classroom.start()
    students.join()
    classroom.wait(classroom.listens)
    classroom.wait_for_marks(3)  # a row for each student
    classroom.wait(lambda: "Queue length, for all assignments: 0." in classroom.get("grace", "class/02_nodes")[1])
    classroom.kill()
    marks = marks_in(classroom.folder / "data")
    assert [receipt.number for receipt in students.receipts] == list(marks) == [1, 2, 3, 4]
    assert list(marks.values()) == [(student, 53.0) for student in CLASS]
