"""A class graded by nbgrader, and by hand in formgrader, has the same sums in all systems."""

from __future__ import annotations

import csv
import secrets
import shutil
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from urllib.parse import urljoin

import nbformat
import pytest
from nbformat import NotebookNode
from playwright.sync_api import Browser, Page, expect

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.report.export import load
from autograder.suite import suites
from tests.browser.jupyter import PATIENCE, serving
from tests.e2e.classroom import Classroom

pytestmark = [
    pytest.mark.browser,
    pytest.mark.slow,
    # nbgrader's use of SQLAlchemy.
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]
ASSIGNMENT = "09_assessment"
CHOICES, QUESTION, MAX_POINTS = "answers", "q2-answer", 6.0
SCHEME = "Mark scheme, 6 points."


@dataclass(frozen=True)
class Student:
    """A student: the submitted code, and the points that the text gets by hand (None if there is no text)."""

    name: str
    code: str
    points: float | None


def students(size: int) -> list[Student]:
    """Return a class, in which every third or fourth student submits the released notebook unchanged."""
    codes = ["no code", "no code", "untouched"] if size == 3 else ["no code", "reference", "flawed", "untouched"]
    members = []
    for number in range(size):
        code = codes[number % len(codes)]
        points = None if code == "untouched" else (number + 1) % (2 * MAX_POINTS + 1) / 2
        members.append(Student(f"s{number:02}", code, points))
    return members


def submit(room: Classroom, student: Student) -> None:
    """Put a student's work into the exchange, as `nbgrader submit` does."""
    answer = None
    if student.code in ("reference", "flawed"):
        answer, sources = room.root / "answers" / student.name, suites.hidden(ASSIGNMENT).sources
        flawed = next(mutant for mutant in mutants(ASSIGNMENT) if not mutant.slow)
        write = write_reference if student.code == "reference" else partial(write_mutant, flawed)
        write(sources, answer)
    room.hand_in(student.name, answer)
    submitted = room.course / "submitted" / student.name / ASSIGNMENT
    path = submitted / f"{ASSIGNMENT}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    if student.points is not None:
        solved = in_form(Chapter(course_paths.chapter(ASSIGNMENT)).read(), Form.SOLVED)
        cell_of(notebook, CHOICES).source = cell_of(solved, CHOICES).source
        cell_of(notebook, QUESTION).source = f"The words of {student.name} about `package.xml`."
    nbformat.write(notebook, path)
    stamp = "2026-05-04 09:00:00.000000 UTC"
    inbound = room.exchange / "ros2-python" / "inbound" / f"{student.name}+{ASSIGNMENT}+{stamp}+{secrets.token_hex(8)}"
    inbound.parent.mkdir(parents=True, exist_ok=True)
    shutil.move(submitted, inbound)
    (inbound / "timestamp.txt").write_text(stamp)
    shutil.rmtree(room.course / "submitted")


def cell_of(notebook: NotebookNode, name: str) -> NotebookNode:
    return next(cell for cell in notebook.cells if cell.id == name)


@pytest.mark.promise(
    "is graded by a person in formgrader",
    "autograder grade submitted --assignment 02_nodes --out .build/nbgrader/02_nodes -j 8",
)
@pytest.mark.parametrize(
    "size", [3, pytest.param(30, marks=[pytest.mark.nightly, pytest.mark.timeout(7200)])], ids=["3", "30"]
)
def test_points_given_in_formgrader_are_added_everywhere(size: int, tmp_path: Path, chromium: Browser) -> None:
    room, members = Classroom(tmp_path / "class", ASSIGNMENT), students(size)
    room.nbgrader("generate_assignment")
    for student in members:
        submit(room, student)
    room.nbgrader("collect")
    graded = room.course / ".build" / "nbgrader" / ASSIGNMENT
    room.grade("-j", "2", "--out", str(graded))
    before = {path: path.stat().st_mtime_ns for path in graded.glob("*/result.json")}
    room.nbgrader("autograde")
    after = {path: path.stat().st_mtime_ns for path in graded.glob("*/result.json")}
    assert after == before, "graded again instead of recorded"
    marks = {result.student: result.score for result in load(graded)}
    assert {student.name for student in members if marks[student.name]} == {
        student.name for student in members if student.points is not None
    }

    grade_by_hand(room, members, tmp_path / "jupyter", chromium)

    expected = {student.name: marks[student.name] + (student.points or 0.0) for student in members}
    room.nbgrader("generate_feedback")
    room.run(room.course, sys.executable, "-m", "nbgrader", "export", "--to=grades.csv")
    with (room.course / "grades.csv").open(encoding="utf-8", newline="") as file:
        exported = {row["student_id"]: float(row["score"]) for row in csv.DictReader(file, strict=True)}
    assert exported == pytest.approx(expected)
    max_score = suites.hidden(ASSIGNMENT).max_score + MAX_POINTS
    for student in members:
        page = room.course / "feedback" / student.name / ASSIGNMENT / f"{ASSIGNMENT}.html"
        assert f"(Score: {expected[student.name]:.1f} / {max_score:.1f})" in page.read_text(encoding="utf-8")


def grade_by_hand(room: Classroom, members: list[Student], home: Path, chromium: Browser) -> None:
    """Enter the points for each student's text in formgrader."""
    home.mkdir()
    points = {f"The words of {student.name} about": student.points for student in members if student.points is not None}
    context = chromium.new_context(viewport={"width": 1100, "height": 900})
    with serving("jupyter_server", home, room.course) as server:
        page = context.new_page()
        page.set_default_timeout(PATIENCE * 1000)
        page.goto(f"{server.url}/login?token={server.token}")
        give_points(page, f"{server.url}/formgrader", len(members), points)
    context.close()


def give_points(page: Page, formgrader: str, submissions: int, points: dict[str, float]) -> None:
    """Open each submission in formgrader, and give the answer that contains a text its points.

    Args:
        page: a page on which the grader is logged in.
        formgrader: the address of formgrader.
        submissions: the number of listed submissions.
        points: the points for each text, which occurs in one submission.
    """
    page.goto(f"{formgrader}/gradebook/{ASSIGNMENT}/{ASSIGNMENT}")
    links = page.locator("a.name-hidden[href*='/submissions/']")
    expect(links).to_have_count(submissions, timeout=PATIENCE * 1000)
    remaining = dict(points)
    for link in [str(item.get_attribute("href")) for item in links.all()]:
        page.goto(urljoin(formgrader, link))
        page.wait_for_function("window.formgrader?.grades?.loaded")  # formgrader ignores keys until then
        body = page.locator("body").inner_text()
        assert SCHEME in body
        for text in [text for text in remaining if text in body]:
            score = page.locator(f"input#{QUESTION}.score")
            score.fill(f"{remaining.pop(text):g}")
            with page.expect_response(lambda answer: "/api/grade/" in answer.url and answer.request.method == "PUT"):
                score.press("Tab")
    assert remaining == {}
