"""Three students answer a chapter of the release, and `check` leads each of them to the end.

One answers everything right at once. One hands `check` a typical mistake first, and corrects it. One writes an exercise
after another, and opens the hints of what fails. Their answers go into the cells of the release, in a real kernel.
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
from tests.notebooks.outputs import said

EACH_TIME = "07_best_practices"
TIMEOUT = 400.0
COUNT = re.compile(r"(\d+) of (\d+) visible checks passed")
FAILED = re.compile(r"^✘ failed .*\n((?:    .*\n)*)", re.MULTILINE)

pytestmark = [pytest.mark.slow, pytest.mark.timeout(2400)]


def each_chapter(*, graded: bool = False) -> list[ParameterSet]:
    """Return the chapters as parameters; `make test` takes one of them."""
    names = suites.graded_assignments() if graded else [chapter.assignment for chapter in chapters()]
    marked = {name: [] if name == EACH_TIME else [pytest.mark.nightly] for name in names}
    return [
        pytest.param(chapter, marks=marked[chapter.assignment], id=chapter.assignment)
        for chapter in chapters()
        if chapter.assignment in marked
    ]


def answers(chapter: Chapter) -> dict[str, str]:
    """Return the right answer of each cell that the release leaves open, by the cell's id."""
    return {cell.id: cell.source for cell in in_form(chapter.read(), Form.SOLVED).cells if is_solution(cell)}


def typical_mistake(chapter: Chapter) -> dict[str, str]:
    """Return a mutant of the reference, as the texts of the cells that it changes.

    A hidden check that it loses has the name of a visible one, and it loses few; where there is none, it loses most.
    """
    right, visible = answers(chapter), {check.id for check in suites.visible(chapter.assignment).checks}
    cells = {text.partition("\n")[0].removeprefix("%%writefile ws/src/"): name for name, text in right.items()}
    candidates = []
    for mutant in mutants(chapter.assignment):
        texts = dict(right)
        for edit in mutant.edits:
            name = cells.get(edit.file)
            if name is None or not edit.find or edit.replace is None or texts[name].count(edit.find) != 1:
                break
            texts[name] = texts[name].replace(edit.find, edit.replace)
        else:
            if not mutant.slow:
                candidates.append((mutant, {name: text for name, text in texts.items() if text != right[name]}))
    seen = [each for each in candidates if each[0].fails & visible]
    return (min if seen else max)(seen or candidates, key=lambda each: len(each[0].fails))[1]


def typed(cell: NotebookNode, text: str, round: int) -> NotebookNode:
    """Return a cell with another text, and with an id of its own for each time that it is run."""
    again = copy.deepcopy(cell)
    again.id, again.source = f"{cell.id}-{round}", text
    return again


class Student:
    """Somebody with a bundle of one chapter.

    Attributes:
        cells: those of the released notebook.
        first: the code cells in front of the first one to write.
        exercises: a list for each heading: the code cells down to the last one to write, or that writes a given file.
        check: the cell that runs all visible checks.
    """

    def __init__(self, bundle: Path, chapter: Chapter) -> None:
        self.path = bundle / "chapters" / chapter.assignment / chapter.notebook_path.name
        self.notebook = nbformat.read(self.path, as_version=4)
        self.cells: list[NotebookNode] = self.notebook.cells
        begins = next(index for index, cell in enumerate(self.cells) if is_solution(cell))
        self.first = [cell for cell in self.cells[:begins] if cell.cell_type == "code"]
        self.check = next(cell for cell in self.cells if cell.source == f"check('{chapter.assignment}')")
        self.exercises: list[list[NotebookNode]] = [[]]
        for cell in self.cells[begins:]:
            if cell.cell_type == "markdown" and re.search("^## ", cell.source, re.MULTILINE):
                self.exercises.append([])
            elif cell.cell_type == "code":
                self.exercises[-1].append(cell)
        for exercise in self.exercises:  # the cells below the last file try it
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
    """Somebody with the bundle of a chapter; the environment is this one, with the autograder in it."""
    with tempfile.TemporaryDirectory() as place:  # short: it holds the kernel's sockets
        bundle = Path(place) / "course"
        write_release(bundle, (chapter.assignment,))
        yield Student(bundle, chapter)


def passed(cell: NotebookNode) -> tuple[int, int]:
    """Return how many of how many visible checks have passed, by what a cell with `check` shows."""
    (found,) = COUNT.findall(said([cell]))
    return int(found[0]), int(found[1])


@pytest.mark.nightly  # the tour has shown it in JupyterLab
@pytest.mark.parametrize("chapter", each_chapter())
def test_right_answers_to_all_exercises_at_once_pass_every_check(chapter: Chapter, student: Student) -> None:
    right = answers(chapter)
    for cell in student.cells:
        cell.source = right.get(cell.id, cell.source)
    ran = {cell.id: cell for cell in student.run(student.cells)}
    count, every = passed(ran[student.check.id])
    assert count == every > 0, said([ran[student.check.id]])


@pytest.mark.parametrize("chapter", each_chapter(graded=True))
def test_a_typical_mistake_fails_with_a_hint_and_its_correction_passes(chapter: Chapter, student: Student) -> None:
    right, wrong = answers(chapter), typical_mistake(chapter)
    written = [cell for exercise in student.exercises for cell in exercise]
    wrongly = [typed(cell, {**right, **wrong}.get(cell.id, cell.source), 1) for cell in written]
    mended = [typed(cell, right[cell.id], 2) for cell in written if cell.id in wrong]
    first, second = (typed(student.check, student.check.source, round) for round in (1, 2))
    ran = {cell.id: cell for cell in student.run([*student.first, *wrongly, first, *mended, second])}
    count, every = passed(ran[first.id])
    assert count < every
    reasons = FAILED.findall(said([ran[first.id]]))
    assert reasons
    assert all("    hint 1: " in reason and not reason.startswith("    hint") for reason in reasons), reasons
    assert passed(ran[second.id]) == (every, every), said([ran[second.id]])


@pytest.mark.parametrize("chapter", each_chapter())
def test_after_each_exercise_check_shows_hints_for_the_next_exercise(chapter: Chapter, student: Student) -> None:
    right = answers(chapter)
    cells = [*student.first, typed(student.check, student.check.source, 0)]
    for round, exercise in enumerate(filter(None, student.exercises), 1):
        cells += [typed(cell, right.get(cell.id, cell.source), round) for cell in exercise]
        cells.append(typed(student.check, student.check.source, round))
    looks = [cell for cell in student.run(cells) if cell.id.startswith(f"{student.check.id}-")]
    counts = [passed(cell) for cell in looks]
    assert counts == sorted(counts)
    assert counts[-1][0] == counts[-1][1], said([looks[-1]])
    for look, (count, every) in zip(looks, counts, strict=True):
        reasons = FAILED.findall(said([look]))
        assert bool(reasons) is (count < every)
        assert all("    hint 1: " in reason for reason in reasons), reasons
