"""The whole way of nbgrader by its real commands, from release to fetched feedback, for a class of three."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from html import unescape
from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode
from nbgrader.api import Gradebook

from autograder import layout, suites
from autograder.course import Form, in_form
from autograder.export import load
from autograder.result import Result

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1800),
    # What nbgrader does with SQLAlchemy.
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]
ASSIGNMENT = "02_nodes"
SOLUTION = "robot-controller"
FLAW = ("HALF_SECTOR = math.radians(30.0)", "HALF_SECTOR = math.radians(180.0)")
CLASS = ("reference", "flawed", "empty")


class Class:
    """A course directory, an exchange and a student's folder, all in one place of their own."""

    def __init__(self, place: Path) -> None:
        self.course, self.exchange, self.place = place / "course", place / "exchange", place
        self.exchange.mkdir(parents=True)
        chapter = Path("chapters") / ASSIGNMENT
        made = shutil.ignore_patterns("build", "install", "log", ".ipynb_checkpoints")
        shutil.copytree(layout.ROOT / chapter, self.course / chapter, ignore=made)
        shutil.copy(layout.ROOT / "nbgrader_config.py", self.course)

    def run(self, folder: Path, *command: str) -> str:
        """Run a command that must succeed; return what it said."""
        # Each person has settings and a cache of their own.
        own = {name: str(folder / ".jupyter") for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR")}
        environment = {**os.environ, **own, "NBGRADER_EXCHANGE": str(self.exchange)}
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, timeout=1200, check=False
        )
        assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
        return done.stdout + done.stderr

    def nbgrader(self, *arguments: str, folder: Path | None = None) -> str:
        return self.run(folder or self.course, sys.executable, "-m", "nbgrader", *arguments)

    def student(self, name: str) -> Path:
        """Make a student's folder, with the configuration that a class is given."""
        folder = self.place / name
        folder.mkdir()
        (folder / "nbgrader_config.py").write_text(
            f"c = get_config()\nc.CourseDirectory.course_id = 'ros2-python'\nc.Exchange.root = {str(self.exchange)!r}\n"
        )
        return folder


def work_of(student: str, released: NotebookNode) -> NotebookNode:
    """Return the notebook that a student hands in."""
    source = nbformat.read(layout.source_notebook(ASSIGNMENT), as_version=4)
    solved = next(cell.source for cell in in_form(source, Form.SOLVED).cells if cell.id == SOLUTION)
    answer = next(cell for cell in released.cells if cell.id == SOLUTION)
    if student == "reference":
        answer.source = solved
    elif student == "flawed":
        assert solved.count(FLAW[0]) == 1
        answer.source = solved.replace(*FLAW)
    return released


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Class:
    """The class after its instructor ran every command, up to the feedback."""
    room = Class(tmp_path_factory.mktemp("class"))
    room.nbgrader("generate_assignment", ASSIGNMENT)
    room.nbgrader("release_assignment", ASSIGNMENT)
    for name in CLASS:
        folder = room.student(name)
        room.nbgrader("fetch_assignment", ASSIGNMENT, folder=folder)
        notebook = folder / ASSIGNMENT / f"{ASSIGNMENT}.ipynb"
        nbformat.write(work_of(name, nbformat.read(notebook, as_version=4)), notebook)
        room.nbgrader("submit", ASSIGNMENT, f"--student={name}", folder=folder)
    room.nbgrader("collect", ASSIGNMENT)
    room.nbgrader("autograde", ASSIGNMENT)
    room.nbgrader("generate_feedback", ASSIGNMENT)
    return room


@pytest.fixture(scope="module")
def results(graded: Class) -> dict[str, Result]:
    """What `autograder grade` says about the same submissions, graded again."""
    out = graded.place / "results" / ASSIGNMENT
    verb = (sys.executable, "-c", "from autograder.cli import main; main()", "grade")
    graded.run(graded.course, *verb, "submitted", "--assignment", ASSIGNMENT, "--out", str(out))
    return {item.result.student: item.result for item in load(out)}


def booked(room: Class, student: str) -> dict[str, tuple[float, float, bool]]:
    with Gradebook(f"sqlite:///{room.course}/gradebook.db") as gradebook:
        submission = gradebook.find_submission_notebook(ASSIGNMENT, ASSIGNMENT, student)
        return {
            grade.name: (grade.auto_score, grade.max_score, grade.needs_manual_grade) for grade in submission.grades
        }


@pytest.mark.parametrize("student", CLASS)
def test_the_gradebook_books_what_the_grader_says(student: str, graded: Class, results: dict[str, Result]) -> None:
    result = results[student]
    expected = {
        f"grade-{name}": (pytest.approx(sum(check.points for check in result.group(name))), worth, False)
        for name, worth in suites.load(ASSIGNMENT).groups.items()
    }
    assert booked(graded, student) == expected
    assert sum(maximum for _, maximum, _ in booked(graded, student).values()) == result.max_score


def test_the_reference_has_all_points_the_flawed_some_and_the_empty_none(results: dict[str, Result]) -> None:
    assert results["reference"].percent == 100.0
    assert 0.0 < results["flawed"].percent < 100.0
    assert results["empty"].score == 0.0


def code_lines(path: Path) -> list[str]:
    """Return a file's lines that are code for sure: calls, without a text that a student may read elsewhere."""
    lines = {line.strip() for line in path.read_text(encoding="utf-8").splitlines()}
    return sorted(line for line in lines if len(line) > 24 and "(" in line and not set("\"'#") & set(line))


def test_the_release_holds_no_solution_and_nothing_of_the_hidden_suite(graded: Class) -> None:
    files = [path for path in (graded.course / "release").rglob("*") if path.is_file()]
    text = "\n".join(path.read_text(encoding="utf-8", errors="replace") for path in files)
    notebook = nbformat.read(graded.course / "release" / ASSIGNMENT / f"{ASSIGNMENT}.ipynb", as_version=4)
    text += "\n".join(cell.source for cell in notebook.cells)
    source = nbformat.read(layout.source_notebook(ASSIGNMENT), as_version=4)
    solution = next(cell.source for cell in source.cells if cell.id == SOLUTION)
    taught = "\n".join(cell.source for cell in source.cells if cell.id != SOLUTION)  # the chapter's own idioms
    hidden = [part.split("# END SOLUTION")[0] for part in solution.split("# BEGIN SOLUTION")[1:]]
    lines = {line.strip() for part in hidden for line in part.splitlines()}
    secret = sorted(line for line in lines if len(line) > 24 and line not in taught)
    assert len(secret) > 10
    assert "YOUR CODE HERE" in text
    assert [line for line in secret if line in text] == []
    suite = suites.load(ASSIGNMENT)
    assert [check.title for check in suite.checks if check.title in text] == []
    assert [line for file in suite.files for line in code_lines(file) if line in text] == []


@pytest.mark.parametrize("student", CLASS)
def test_the_feedback_explains_and_shows_no_source_of_the_suite(student: str, graded: Class) -> None:
    path = graded.course / "feedback" / student / ASSIGNMENT / f"{ASSIGNMENT}.html"
    html = unescape(path.read_text(encoding="utf-8"))
    suite = suites.load(ASSIGNMENT)
    (stored,) = load(graded.course / ".build" / "nbgrader" / ASSIGNMENT / student)
    for check in stored.result.checks:
        assert check.title in html
        if check.points < check.max_points:
            assert check.message in html
    assert html.count("data:image/png;base64,") >= len(stored.result.artifacts)
    assert [line for file in suite.files for line in code_lines(file) if line in html] == []
    assert "def test_" not in html


def test_outputs_of_the_sandboxed_kernel_are_in_the_autograded_notebook(graded: Class) -> None:
    path = graded.course / "autograded" / "reference" / ASSIGNMENT / f"{ASSIGNMENT}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    solution = next(cell for cell in notebook.cells if cell.id == SOLUTION)
    assert [output.text.split()[0] for output in solution.outputs] in (["Writing"], ["Overwriting"])


def test_students_fetch_their_feedback(graded: Class) -> None:
    graded.nbgrader("release_feedback", ASSIGNMENT)
    folder = graded.place / "flawed"
    graded.nbgrader("fetch_feedback", ASSIGNMENT, folder=folder)
    (page,) = (folder / ASSIGNMENT / "feedback").rglob("*.html")
    made = graded.course / "feedback" / "flawed" / ASSIGNMENT / f"{ASSIGNMENT}.html"
    assert page.read_bytes() == made.read_bytes()


def test_results_graded_in_parallel_before_can_be_booked(graded: Class, results: dict[str, Result]) -> None:
    stored = graded.place / "results"
    before = (stored / ASSIGNMENT / "flawed" / "result.json").stat().st_mtime_ns
    booked_before = booked(graded, "flawed")
    options = ("--SandboxedGrade.resume=True", f"--SandboxedGrade.results={stored}", "--student=flawed", "--force")
    graded.nbgrader("autograde", ASSIGNMENT, *options)
    assert (stored / ASSIGNMENT / "flawed" / "result.json").stat().st_mtime_ns == before
    assert booked(graded, "flawed") == booked_before
    assert sum(points for points, _, _ in booked_before.values()) == pytest.approx(results["flawed"].score)


def test_one_that_drops_the_exercise_gets_nothing_for_what_is_put_back(graded: Class) -> None:
    folder = graded.course / "submitted" / "dropped" / ASSIGNMENT
    shutil.copytree(graded.course / "submitted" / "empty" / ASSIGNMENT, folder)
    notebook = nbformat.read(folder / f"{ASSIGNMENT}.ipynb", as_version=4)
    notebook.cells = [cell for cell in notebook.cells if "nbgrader" not in cell.metadata]
    nbformat.write(notebook, folder / f"{ASSIGNMENT}.ipynb")
    graded.nbgrader("autograde", ASSIGNMENT, "--student=dropped")
    grades = booked(graded, "dropped")
    assert {points for points, _, _ in grades.values()} == {0.0}
    assert sum(maximum for _, maximum, _ in grades.values()) == suites.load(ASSIGNMENT).max_score
