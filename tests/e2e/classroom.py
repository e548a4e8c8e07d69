"""A class in a separate folder: an instructor's course directory, and students who submit their work."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell
from nbgrader.api import Gradebook

from autograder import course_paths
from autograder.author.course.cells import is_solution
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.suite import suites

Grades = dict[str, tuple[float, float, bool]]


class Classroom:
    """A course directory, an exchange and the students' folders.

    Args:
        root: the folder that contains them.
        assignment: the assignment of the class.
    """

    def __init__(self, root: Path, assignment: str) -> None:
        self.root, self.assignment = root, assignment
        self.course, self.exchange = root / "course", root / "exchange"
        self.exchange.mkdir(parents=True)
        shutil.copytree(
            course_paths.chapter(assignment), self.course / "chapters" / assignment, ignore=course_paths.NOT_COPIED
        )
        shutil.copy(course_paths.ROOT / "nbgrader_config.py", self.course)

    def run(self, folder: Path, *command: str) -> str:
        """Run a command that must succeed; return its output."""
        # Each person has their own settings and cache.
        own_folders = {
            name: str(folder / ".jupyter") for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR")
        }
        environment = {**os.environ, **own_folders, "NBGRADER_EXCHANGE": str(self.exchange)}
        completed = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, timeout=1800, check=False
        )
        assert completed.returncode == 0, f"{command}\n{completed.stdout}\n{completed.stderr}"
        return completed.stdout + completed.stderr

    def nbgrader(self, verb: str, *arguments: str, folder: Path | None = None) -> str:
        """Run a verb of nbgrader on the assignment, in the course directory or in a student's folder."""
        command = (sys.executable, "-m", "nbgrader", verb, self.assignment, *arguments)
        return self.run(folder or self.course, *command)

    def grade(self, *options: str) -> Path:
        """Grade all submissions with `autograder grade`; return the folder of the results."""
        out = self.root / "results" / self.assignment
        verb = (sys.executable, "-c", "from autograder.cli import main; main()", "grade")
        self.run(self.course, *verb, "submitted", "--assignment", self.assignment, "--out", str(out), *options)
        return out

    def grades(self, student: str) -> Grades:
        """Return each grade cell's points in the gradebook, its maximum, and whether it needs manual grading."""
        with Gradebook(f"sqlite:///{self.course}/gradebook.db") as gradebook:
            submission = gradebook.find_submission_notebook(self.assignment, self.assignment, student)
            return {
                grade.name: (grade.auto_score, grade.max_score, grade.needs_manual_grade) for grade in submission.grades
            }

    def hand_in(self, student: str, answer: Path | None = None) -> None:
        """Put a student's released assignment where nbgrader collects them.

        Args:
            student: the student's name.
            answer: a source tree whose `src` the notebook is to write, or None for an unchanged notebook.
        """
        folder = self.course / "submitted" / student / self.assignment
        shutil.copytree(self.course / "release" / self.assignment, folder)
        if answer is None:
            return
        path = folder / f"{self.assignment}.ipynb"
        notebook = nbformat.read(path, as_version=4)
        fill_in(notebook, self.assignment)
        add_cells_for_changes(notebook, self.assignment, answer / "src")
        nbformat.write(notebook, path)


def fill_in(released: NotebookNode, assignment: str) -> None:
    """Give a released notebook the reference's answers."""
    solved = in_form(Chapter(course_paths.chapter(assignment)).read(), Form.SOLVED)
    answers = {cell.id: cell.source for cell in solved.cells if is_solution(cell)}
    for cell in released.cells:
        cell.source = answers.get(cell.id, cell.source)


def add_cells_for_changes(notebook: NotebookNode, assignment: str, src: Path) -> None:
    """Make a solved notebook write the files of `src` that differ from the reference, by changed and new cells."""
    cells = {cell.source.partition("\n")[0]: cell for cell in notebook.cells if cell.cell_type == "code"}
    for name, text in changed_files(assignment, src):
        magic = f"%%writefile ws/src/{name}"
        if text is None:
            notebook.cells.append(new_code_cell(f"!rm ws/src/{name}"))
        elif not text:  # %%writefile does not write an empty file
            notebook.cells.append(new_code_cell(f"!: > ws/src/{name}"))
        elif magic in cells:
            cells[magic].source = f"{magic}\n{text}"
        else:
            notebook.cells.append(new_code_cell(f"!mkdir -p {Path('ws/src', name).parent}"))
            notebook.cells.append(new_code_cell(f"{magic}\n{text}"))


def changed_files(assignment: str, src: Path) -> Iterator[tuple[str, str | None]]:
    """Yield the name and text of each file that differs from the reference; the text of a deleted file is None."""
    sources = suites.hidden(assignment).sources
    reference = {name: (course_paths.SOLUTIONS / name).read_text() for name in files(course_paths.SOLUTIONS, sources)}
    submitted = {name: (src / name).read_text() for name in files(src, sources)}
    for name in sorted(reference.keys() | submitted.keys()):
        if reference.get(name) != submitted.get(name):
            text = submitted.get(name)
            yield name, None if text is None else text.removesuffix("\n")


def files(root: Path, folders: tuple[str, ...]) -> list[str]:
    """Return the files in some folders of `root`, without Python's caches."""
    paths = (path for folder in folders for path in (root / folder).rglob("*") if path.is_file())
    return [str(path.relative_to(root)) for path in paths if "__pycache__" not in path.parts]
