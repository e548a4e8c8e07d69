"""nbgrader's own commands take a class of four from the release to the fetched feedback."""

from __future__ import annotations

import json
import shutil
from html import unescape
from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell

from autograder import course_paths
from autograder.report.export import load
from autograder.result.model import Result
from autograder.suite import Outcome, suites
from tests.e2e.classroom import Classroom, fill_in

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1800),
    # nbgrader's use of SQLAlchemy.
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]
ASSIGNMENT = "02_nodes"
SOLUTION = "robot-controller"
FLAW = ("HALF_SECTOR = math.radians(30.0)", "HALF_SECTOR = math.radians(180.0)")
CLASS = ("reference", "flawed", "empty", "odd")


def make_folder(student: str, room: Classroom) -> Path:
    """Create a student's folder, with the configuration for the class."""
    folder = room.root / student
    folder.mkdir()
    (folder / "nbgrader_config.py").write_text(
        f"c = get_config()\nc.CourseDirectory.course_id = 'ros2-python'\nc.Exchange.root = {str(room.exchange)!r}\n"
    )
    return folder


def solve(student: str, released: NotebookNode) -> NotebookNode:
    """Return the notebook that a student submits."""
    if student != "empty":
        fill_in(released, ASSIGNMENT)
    if student == "reference":
        # The grader cannot know what this cell does, so it runs the notebook.
        released.cells.append(new_code_cell("print('mine')"))
    if student == "odd":  # JupyterLab opens such a notebook, but nbformat's schema rejects it
        released.nbformat_minor = 4
        released.cells[1].outputs = [NotebookNode(output_type="stream", text="hi")]
        del released.cells[3]["outputs"]
    if student == "flawed":
        answer = next(cell for cell in released.cells if cell.id == SOLUTION)
        assert answer.source.count(FLAW[0]) == 1
        answer.source = answer.source.replace(*FLAW)
    return released


@pytest.fixture(scope="module")
def graded_class(tmp_path_factory: pytest.TempPathFactory) -> Classroom:
    """The class after its instructor has run all commands up to `generate_feedback`."""
    room = Classroom(tmp_path_factory.mktemp("class"), ASSIGNMENT)
    room.nbgrader("generate_assignment")
    room.nbgrader("release_assignment")
    for name in CLASS:
        folder = make_folder(name, room)
        room.nbgrader("fetch_assignment", folder=folder)
        notebook = folder / ASSIGNMENT / f"{ASSIGNMENT}.ipynb"
        solved = solve(name, nbformat.read(notebook, as_version=4))
        notebook.write_text(json.dumps(solved), encoding="utf-8")  # nbformat would repair it
        room.nbgrader("submit", f"--student={name}", folder=folder)
    room.nbgrader("collect")
    room.nbgrader("autograde")
    room.nbgrader("generate_feedback")
    return room


@pytest.fixture(scope="module")
def results(graded_class: Classroom) -> dict[str, Result]:
    """The results of `autograder grade --resume`, which grades the flawed submission and reuses the other results."""
    for name in ("reference", "empty", "odd"):
        stored = graded_class.course / ".build" / "nbgrader" / ASSIGNMENT / name
        shutil.copytree(stored, graded_class.root / "results" / ASSIGNMENT / name)
    return {result.student: result for result in load(graded_class.grade("--resume"))}


@pytest.mark.promise(
    "`autograde` takes its points from this course's grader.", "nbgrader's gradebook, by `nbgrader autograde`"
)
@pytest.mark.parametrize("student", CLASS)
def test_the_gradebook_has_the_points_that_the_grader_gave(
    student: str, graded_class: Classroom, results: dict[str, Result]
) -> None:
    result = results[student]
    groups, grades = suites.hidden(ASSIGNMENT).groups, graded_class.grades(student)
    assert {name: score for name, (score, _, _) in grades.items()} == pytest.approx(
        {f"grade-{name}": sum(check.points for check in result.group(name)) for name in groups}
    )
    assert {name: (maximum, by_hand) for name, (_, maximum, by_hand) in grades.items()} == {
        f"grade-{name}": (worth, False) for name, worth in groups.items()
    }
    assert sum(maximum for _, maximum, _ in grades.values()) == result.max_score


def test_the_reference_gets_full_marks_flawed_answers_some_and_empty_ones_none(results: dict[str, Result]) -> None:
    assert results["reference"].percent == results["odd"].percent == 100.0
    assert 0.0 < results["flawed"].percent < 100.0
    assert results["empty"].score == 0.0


def code_lines(path: Path) -> list[str]:
    """Return a file's lines that are certainly code: calls without strings or comments, which may occur elsewhere."""
    lines = {line.strip() for line in path.read_text(encoding="utf-8").splitlines()}
    return sorted(line for line in lines if len(line) > 24 and "(" in line and not set("\"'#") & set(line))


def test_the_release_contains_no_solution_and_nothing_of_the_hidden_suite(graded_class: Classroom) -> None:
    files = [path for path in (graded_class.course / "release").rglob("*") if path.is_file()]
    text = "\n".join(path.read_text(encoding="utf-8", errors="replace") for path in files)
    notebook = nbformat.read(graded_class.course / "release" / ASSIGNMENT / f"{ASSIGNMENT}.ipynb", as_version=4)
    text += "\n".join(cell.source for cell in notebook.cells)
    source = nbformat.read(course_paths.source_notebook(ASSIGNMENT), as_version=4)
    solution = next(cell.source for cell in source.cells if cell.id == SOLUTION)
    visible = "\n".join(cell.source for cell in source.cells if cell.id != SOLUTION)  # the chapter uses the same idioms
    hidden = [part.split("# END SOLUTION")[0] for part in solution.split("# BEGIN SOLUTION")[1:]]
    lines = {line.strip() for part in hidden for line in part.splitlines()}
    secret = sorted(line for line in lines if len(line) > 24 and line not in visible)
    assert len(secret) > 10
    assert "YOUR CODE HERE" in text
    assert [line for line in secret if line in text] == []
    suite = suites.hidden(ASSIGNMENT)
    assert [check.title for check in suite.checks if check.title in text] == []
    assert [line for file in suite.files for line in code_lines(file) if line in text] == []


@pytest.mark.parametrize("student", CLASS)
def test_the_feedback_explains_failures_and_contains_no_source_of_the_suite(
    student: str, graded_class: Classroom
) -> None:
    path = graded_class.course / "feedback" / student / ASSIGNMENT / f"{ASSIGNMENT}.html"
    html = unescape(path.read_text(encoding="utf-8"))
    suite = suites.hidden(ASSIGNMENT)
    (stored,) = load(graded_class.course / ".build" / "nbgrader" / ASSIGNMENT / student)
    for check in stored.checks:
        assert check.title in html
        if check.outcome is Outcome.FAILED:  # skipped checks are folded below the failed one
            assert check.message in html
    assert html.count("data:image/png;base64,") >= len(stored.artifacts)
    assert [line for file in suite.files for line in code_lines(file) if line in html] == []
    assert "def test_" not in html


def test_outputs_of_the_sandboxed_kernel_are_in_the_autograded_notebook(graded_class: Classroom) -> None:
    path = graded_class.course / "autograded" / "reference" / ASSIGNMENT / f"{ASSIGNMENT}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    solution = next(cell for cell in notebook.cells if cell.id == SOLUTION)
    assert [output.text.split()[0] for output in solution.outputs] in (["Writing"], ["Overwriting"])


@pytest.mark.promise("`release_assignment`, `collect`, `autograde` and `generate_feedback` work as usual.")
def test_students_fetch_their_feedback(graded_class: Classroom) -> None:
    graded_class.nbgrader("release_feedback")
    folder = graded_class.root / "flawed"
    graded_class.nbgrader("fetch_feedback", folder=folder)
    (page,) = (folder / ASSIGNMENT / "feedback").rglob("*.html")
    generated = graded_class.course / "feedback" / "flawed" / ASSIGNMENT / f"{ASSIGNMENT}.html"
    assert page.read_bytes() == generated.read_bytes()


@pytest.mark.promise(
    "nbgrader autograde 02_nodes",
    "`autograde` records that result instead of grading again.",
)
def test_autograde_records_results_of_an_earlier_grading(graded_class: Classroom, results: dict[str, Result]) -> None:
    stored = graded_class.root / "results"
    before = (stored / ASSIGNMENT / "flawed" / "result.json").stat().st_mtime_ns
    recorded_before = graded_class.grades("flawed")
    options = (f"--SandboxedGrade.results={stored}", "--student=flawed", "--force")
    graded_class.nbgrader("autograde", *options)
    assert (stored / ASSIGNMENT / "flawed" / "result.json").stat().st_mtime_ns == before
    assert graded_class.grades("flawed") == recorded_before
    assert sum(points for points, _, _ in recorded_before.values()) == pytest.approx(results["flawed"].score)


def test_a_restored_exercise_cell_earns_no_points(graded_class: Classroom) -> None:
    graded_class.hand_in("dropped")
    folder = graded_class.course / "submitted" / "dropped" / ASSIGNMENT
    notebook = nbformat.read(folder / f"{ASSIGNMENT}.ipynb", as_version=4)
    notebook.cells = [cell for cell in notebook.cells if "nbgrader" not in cell.metadata]
    nbformat.write(notebook, folder / f"{ASSIGNMENT}.ipynb")
    graded_class.nbgrader("autograde", "--student=dropped")
    grades = graded_class.grades("dropped")
    assert {points for points, _, _ in grades.values()} == {0.0}
    assert sum(maximum for _, maximum, _ in grades.values()) == suites.hidden(ASSIGNMENT).max_score
