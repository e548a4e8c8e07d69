"""A class on a hub works in the browser from the first login to the feedback, with the same sums everywhere.

`tests/e2e/test_hub.py` covers the main steps over HTTP in `make test`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from nbgrader.api import Gradebook
from playwright.sync_api import Browser, Page, expect

from autograder import course_paths
from autograder.author.course.cells import is_solution
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.lms.hub.trial import Hub
from autograder.lms.hub.trial import serving as serving_hub
from autograder.suite import suites
from tests.browser.jupyter import Lab
from tests.browser.test_formgrader import ASSIGNMENT, MAX_POINTS, QUESTION, give_points
from tests.browser.test_solve_in_jupyterlab import outputs, type_in
from tests.browser.test_students_lab import OPEN
from tests.e2e.test_hub import ON_A_HUB, shared_folder

__all__ = ["shared_folder"]

pytestmark = [
    pytest.mark.browser,
    pytest.mark.nightly,
    pytest.mark.timeout(3600),
    *ON_A_HUB,
    # nbgrader's use of SQLAlchemy.
    pytest.mark.filterwarnings("ignore:Object of type <Submitted:sqlalchemy.exc.SAWarning"),
]
PATIENCE = 300_000.0  # milliseconds: a deadline, not an expectation
NOTEBOOK = f"{ASSIGNMENT}/{ASSIGNMENT}.ipynb"
ANSWERS, RIGHT, INVALID, WRONG = f"{ASSIGNMENT}/ws/src/assessment/answers.yaml", "q12: c", "q12: e", "q12: d"
SETTINGS = "c = get_config()\nc.LabApp.expose_app_in_browser = True\n"
RUN = """async ids => {
    const notebook = window.jupyterapp.shell.currentWidget.content;
    for (const id of ids) {
        notebook.activeCellIndex = notebook.widgets.findIndex(cell => cell.model.id === id);
        notebook.deselectAll();
        await window.jupyterapp.commands.execute("notebook:run-cell");
    }
    await window.jupyterapp.commands.execute("docmanager:save");
}"""


@dataclass(frozen=True)
class Person:
    """A user who is logged in to the hub in a separate browser context."""

    hub: Hub
    name: str
    page: Page

    @property
    def url(self) -> str:
        """The address of this person's server."""
        return f"{self.hub.url}/user/{self.name}"

    @property
    def home(self) -> Path:
        """This person's home folder."""
        return self.hub.homes / self.name

    def open_assignments(self) -> None:
        """Open JupyterLab with nbgrader's list of assignments."""
        self.page.goto(f"{self.url}/lab/workspaces/assignments?reset")
        self.page.wait_for_function("window.jupyterapp?.restored.then(() => true)")
        self.page.evaluate("() => { window.jupyterapp.commands.execute('nbgrader:open-assignment-list'); }")

    def press(self, button: str, *, until: str) -> None:
        """Press the assignment's button in nbgrader's list, and wait for the next button."""
        row = self.page.locator(".list_item", has_text=ASSIGNMENT)
        row.get_by_role("button", name=button, exact=True).first.click()
        expect(row.get_by_role("button", name=until, exact=True).first).to_be_visible(timeout=PATIENCE)

    def show(self) -> None:
        """Open the assignment's notebook."""
        Lab(self.url, "", self.home).show(self.page, NOTEBOOK)

    def run(self, *cells: str) -> str:
        """Run cells of the notebook, save it, and return the output of the last one."""
        self.page.evaluate(RUN, list(cells))
        return str(outputs(self.page)[cells[-1]])

    def manage(self, page: str, row: str, column: str) -> None:
        """Click in a row of one of formgrader's tables, and wait until nbgrader has finished."""
        self.page.goto(f"{self.url}/formgrader/{page}")
        self.page.locator("tr", has_text=row).locator(f".{column} a").click()
        dialog = self.page.locator("#success-modal, #error-modal")
        expect(dialog).to_be_visible(timeout=PATIENCE)
        assert "Success" in dialog.inner_text(), dialog.inner_text()


@contextmanager
def logged_in(chromium: Browser, hub: Hub, name: str) -> Iterator[Person]:
    """Log in by the hub's page in a browser without cookies, and wait for JupyterLab."""
    settings = hub.homes / name / ".jupyter"
    settings.mkdir(exist_ok=True)
    (settings / "jupyter_lab_config.py").write_text(SETTINGS)  # so that the test can call JupyterLab's commands
    context = chromium.new_context(viewport={"width": 1100, "height": 900})
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(f"{hub.url}/hub/login?next=/hub/spawn")
    page.locator("#username_input").fill(name)
    page.locator("#password_input").fill(hub.password)
    page.locator("#login_submit").click()
    page.wait_for_function("window.jupyterapp")
    yield Person(hub, name, page)
    context.close()


def solved_cells() -> dict[str, str]:
    """Return the reference answer of each cell that students fill, by the cell's id, in the notebook's order."""
    solved = in_form(Chapter(course_paths.chapter(ASSIGNMENT)).read(), Form.SOLVED)
    return {cell.id: cell.source for cell in solved.cells if is_solution(cell)}


def all_pass(output: str) -> bool:
    """Return whether a cell with `check(...)` shows that each visible check passed."""
    count = re.search(r"(\d+) of (\d+) visible checks passed", output)
    assert count, output
    return count[1] == count[2]


def solve_all(student: Person) -> None:
    """Answer each question as the reference does, and run the check."""
    student.show()
    solved = solved_cells()
    for cell, source in solved.items():
        if cell != QUESTION:
            type_in(student.page, cell, source)
    type_in(student.page, QUESTION, f"The words of {student.name} about `package.xml`.")
    answers, *files = [cell for cell in solved if cell != QUESTION]
    assert all_pass(student.run("setup", answers, "create", "running", *files, "check-run"))


def answer_in_the_editor(student: Person) -> None:
    """Answer two questions. The check rejects an invalid letter; then the editor gets a wrong one."""
    student.show()
    type_in(student.page, "answers", solved_cells()["answers"].replace(RIGHT, INVALID))
    type_in(student.page, QUESTION, f"The words of {student.name} about `package.xml`.")
    assert not all_pass(student.run("setup", "answers", "check-question-1"))
    student.page.evaluate(OPEN, ANSWERS)
    editor = student.page.locator(".jp-FileEditor .cm-content")
    text = (student.home / ANSWERS).read_text()
    editor.click()
    student.page.keyboard.press("Control+A")
    student.page.keyboard.insert_text(text.replace(INVALID, WRONG))
    student.page.keyboard.press("Control+S")
    expect(student.page.locator(".jp-mod-dirty")).to_have_count(0, timeout=PATIENCE)
    student.show()
    assert all_pass(student.run("setup", "check-question-1"))


def score_in_formgrader(teacher: Person, student: Person) -> str:
    teacher.page.goto(f"{teacher.url}/formgrader/manage_submissions/{ASSIGNMENT}")
    return teacher.page.locator("tr", has_text=student.name).locator(".score").inner_text()


def check_a_class(hub: Hub, chromium: Browser) -> None:
    """Let two students and the teacher of a new hub do their work in the browser."""
    suite = suites.hidden(ASSIGNMENT)
    max_score = suite.max_score + MAX_POINTS
    with (
        logged_in(chromium, hub, hub.teacher) as teacher,
        logged_in(chromium, hub, hub.students[0]) as ada,
        logged_in(chromium, hub, hub.students[1]) as ben,
    ):
        for step in ("assign", "release"):
            teacher.manage("manage_assignments", ASSIGNMENT, step)
        for student in (ada, ben):
            student.open_assignments()
            student.press("Fetch", until="Submit")
        solve_all(ada)
        answer_in_the_editor(ben)
        for student in (ada, ben):
            student.open_assignments()
            student.press("Submit", until="Fetch Feedback")

        teacher.manage("manage_assignments", ASSIGNMENT, "collect")
        for student in (ada, ben):
            teacher.manage(f"manage_submissions/{ASSIGNMENT}", student.name, "autograde")
        choices = sum(check.points for check in suite.checks if check.group == "choices")
        expected = {ada: suite.max_score + 5.5, ben: choices - 1 + 3}
        points = {f"The words of {ada.name} about": 5.5, f"The words of {ben.name} about": 3.0}
        give_points(teacher.page, f"{teacher.url}/formgrader", len(points), points)
        for step in ("generate-feedback", "release-feedback"):
            teacher.manage("manage_assignments", ASSIGNMENT, step)

        for student, score in expected.items():
            assert score_in_formgrader(teacher, student) == f"{score:g} / {max_score:g}"
            student.open_assignments()
            student.press("Fetch Feedback", until="Fetch Feedback")
            student.page.get_by_text("(view feedback)").click()
            (feedback,) = (student.home / ASSIGNMENT / "feedback").rglob(f"{ASSIGNMENT}.html")
            student.page.goto(f"{student.url}/files/{feedback.relative_to(student.home)}")
            expect(student.page.locator("body")).to_contain_text(
                f"(Score: {score:.1f} / {max_score:.1f})", timeout=PATIENCE
            )
        response = ben.page.goto(f"{ada.url}/files/{NOTEBOOK}")
        assert response is not None
        assert response.status == 403
        with Gradebook(f"sqlite:///{teacher.home}/course/gradebook.db") as gradebook:
            recorded = {name: gradebook.find_submission(ASSIGNMENT, name).score for name in (ada.name, ben.name)}
        assert recorded == {student.name: score for student, score in expected.items()}


def test_students_and_their_teacher_do_all_their_work_in_the_browser(shared_folder: Path, chromium: Browser) -> None:
    with serving_hub(shared_folder, course_paths.ROOT) as hub:
        check_a_class(hub, chromium)
