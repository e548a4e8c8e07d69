"""Two students solve a chapter of the release with the help of `check`.

One makes a typical mistake first, and corrects it. One solves one exercise after the other, and reads the hints of
failed checks. Their answers replace the texts of the release's cells, which run in a kernel. A student who solves all
exercises at once is in `tests/browser/test_solve_in_jupyterlab.py`.
"""

from __future__ import annotations

import copy
import re
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import nbformat
import pytest
from _pytest.mark import ParameterSet
from nbformat import NotebookNode

from autograder.author.course.cells import is_solution, metadata
from autograder.author.course.execute import execute
from autograder.author.course.forms import Form, in_form
from autograder.author.course.release import write_release
from autograder.author.course.sync import Chapter, chapters
from autograder.author.verification.mutants import mutants
from autograder.ros.domains import Domain
from autograder.suite import suites
from tests.notebooks.outputs import text_of

EVERY_RUN = "07_best_practices"
TIMEOUT = 400.0
COUNT = re.compile(r"(\d+) of (\d+) visible checks passed")
FAILED = re.compile(r"^✘ failed .*\n((?:    .*\n)*)", re.MULTILINE)

pytestmark = [pytest.mark.slow, pytest.mark.timeout(2400)]


def each_chapter(*, graded: bool = False) -> list[ParameterSet]:
    """Return the chapters as parameters; `make test` runs one of them."""
    names = suites.graded_assignments() if graded else [chapter.assignment for chapter in chapters()]
    marks = {name: [] if name == EVERY_RUN else [pytest.mark.nightly] for name in names}
    return [
        pytest.param(chapter, marks=marks[chapter.assignment], id=chapter.assignment)
        for chapter in chapters()
        if chapter.assignment in marks
    ]


def answers(chapter: Chapter) -> dict[str, str]:
    """Return the correct answer of each cell that students fill, by the cell's id."""
    return {cell.id: cell.source for cell in in_form(chapter.read(), Form.SOLVED).cells if is_solution(cell)}


def typical_mistake(chapter: Chapter) -> dict[str, str]:
    """Return a mutant of the reference, as the texts of the cells that it changes.

    If possible, it fails a hidden check with the name of a visible one, and few others; otherwise, the most checks.
    """
    correct, visible = answers(chapter), {check.id for check in suites.visible(chapter.assignment).checks}
    cells = {text.partition("\n")[0].removeprefix("%%writefile ws/src/"): name for name, text in correct.items()}
    candidates = []
    for mutant in mutants(chapter.assignment):
        texts = dict(correct)
        for edit in mutant.edits:
            name = cells.get(edit.file)
            if name is None or not edit.find or edit.replace is None or texts[name].count(edit.find) != 1:
                break
            texts[name] = texts[name].replace(edit.find, edit.replace)
        else:
            if not mutant.slow:
                candidates.append((mutant, {name: text for name, text in texts.items() if text != correct[name]}))
    detected = [candidate for candidate in candidates if candidate[0].fails & visible]
    return (min if detected else max)(detected or candidates, key=lambda candidate: len(candidate[0].fails))[1]


def filled_cell(cell: NotebookNode, text: str, round: int) -> NotebookNode:
    """Return a copy of a cell with another text, and with a different id for each round."""
    filled = copy.deepcopy(cell)
    filled.id, filled.source = f"{cell.id}-{round}", text
    return filled


class Student:
    """A student with the release of one chapter.

    Attributes:
        cells: the cells of the released notebook.
        first: the code cells before the first one that students fill.
        exercises: for each heading, the code cells up to the last one that students fill or that writes a given file.
        check: the cell that runs all visible checks.
    """

    def __init__(self, release: Path, chapter: Chapter) -> None:
        self.path = release / "chapters" / chapter.assignment / chapter.notebook_path.name
        self.notebook = nbformat.read(self.path, as_version=4)
        self.cells: list[NotebookNode] = self.notebook.cells
        start = next(index for index, cell in enumerate(self.cells) if is_solution(cell))
        self.first = [cell for cell in self.cells[:start] if cell.cell_type == "code"]
        self.check = next(cell for cell in self.cells if cell.source == f"check('{chapter.assignment}')")
        self.exercises: list[list[NotebookNode]] = [[]]
        for cell in self.cells[start:]:
            if cell.cell_type == "markdown" and re.search("^## ", cell.source, re.MULTILINE):
                self.exercises.append([])
            elif cell.cell_type == "code":
                self.exercises[-1].append(cell)
        for exercise in self.exercises:  # the cells after the last file only try it out
            while exercise and not (is_solution(exercise[-1]) or "source" in metadata(exercise[-1])):
                exercise.pop()

    def run(self, cells: Sequence[NotebookNode]) -> list[NotebookNode]:
        """Run cells in a kernel in the chapter's folder; return them with their outputs."""
        self.notebook.cells = copy.deepcopy(list(cells))
        with Domain() as domain:
            failure = execute(self.notebook, self.path.parent, TIMEOUT, domain.number)
        assert failure is None, failure
        return list(self.notebook.cells)


@pytest.fixture
def student(chapter: Chapter) -> Iterator[Student]:
    """A student with the release of a chapter, in this environment, which has the autograder."""
    with tempfile.TemporaryDirectory() as folder:  # a short path, for the kernel's sockets
        release = Path(folder) / "course"
        write_release(release, (chapter.assignment,))
        yield Student(release, chapter)


def passed(cell: NotebookNode) -> tuple[int, int]:
    """Return the numbers of passed and of all visible checks that a cell with `check` shows."""
    (numbers,) = COUNT.findall(text_of([cell]))
    return int(numbers[0]), int(numbers[1])


@pytest.mark.parametrize("chapter", each_chapter(graded=True))
def test_a_typical_mistake_fails_with_a_hint_and_its_correction_passes(chapter: Chapter, student: Student) -> None:
    correct, mistake = answers(chapter), typical_mistake(chapter)
    cells = [cell for exercise in student.exercises for cell in exercise]
    with_mistake = [filled_cell(cell, {**correct, **mistake}.get(cell.id, cell.source), 1) for cell in cells]
    corrected = [filled_cell(cell, correct[cell.id], 2) for cell in cells if cell.id in mistake]
    first_check, second_check = (filled_cell(student.check, student.check.source, round) for round in (1, 2))
    executed = {
        cell.id: cell for cell in student.run([*student.first, *with_mistake, first_check, *corrected, second_check])
    }
    count, total = passed(executed[first_check.id])
    assert count < total
    reasons = FAILED.findall(text_of([executed[first_check.id]]))
    assert reasons
    assert all("    hint 1: " in reason and not reason.startswith("    hint") for reason in reasons), reasons
    assert passed(executed[second_check.id]) == (total, total), text_of([executed[second_check.id]])


@pytest.mark.parametrize("chapter", each_chapter())
def test_after_each_exercise_check_shows_hints_for_the_next_exercise(chapter: Chapter, student: Student) -> None:
    correct = answers(chapter)
    cells = [*student.first, filled_cell(student.check, student.check.source, 0)]
    for round, exercise in enumerate(filter(None, student.exercises), 1):
        cells += [filled_cell(cell, correct.get(cell.id, cell.source), round) for cell in exercise]
        cells.append(filled_cell(student.check, student.check.source, round))
    reports = [cell for cell in student.run(cells) if cell.id.startswith(f"{student.check.id}-")]
    counts = [passed(cell) for cell in reports]
    assert counts == sorted(counts)
    assert counts[-1][0] == counts[-1][1], text_of([reports[-1]])
    for report, (count, total) in zip(reports, counts, strict=True):
        reasons = FAILED.findall(text_of([report]))
        assert bool(reasons) is (count < total)
        assert all("    hint 1: " in reason for reason in reasons), reasons
