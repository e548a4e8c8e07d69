"""JupyterLab keeps a student's work, and has no button that reports an unsolved notebook as correct."""

from __future__ import annotations

import shutil
from pathlib import Path

import nbformat
import pytest
from nbformat.v4 import new_code_cell
from playwright.sync_api import Page, expect

from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import chapters
from autograder.notebook.writefile import REPLACED
from tests.browser.jupyter import PATIENCE, Lab, lab

__all__ = ["lab"]

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FIRST = next(chapter for chapter in chapters() if chapter.assignment == "00_welcome")
FILE = "ws/src/first_robot/first_robot/square.py"
ANSWER = "# written in the editor\n"
CELL = f"%%writefile {FILE}\n# written in the cell\n"
OPEN = """async path => {
    const editor = await window.jupyterapp.commands.execute("docmanager:open", {path, factory: "Editor"});
    await editor.context.ready;
}"""
# Jupyter's own command without its dialog, which ends with the last cell. It also saves the notebook, which JupyterLab
# would do two minutes later: until then, a marker shows unsaved changes.
RUN_ALL = """async () => {
    const panel = window.jupyterapp.shell.currentWidget;
    await panel.sessionContext.session.kernel.restart();
    await window.jupyterapp.commands.execute("notebook:run-all-cells");
    await window.jupyterapp.commands.execute("docmanager:save");
    return panel.content.widgets.filter(cell => cell.model.type === "code").map(cell => cell.model.executionCount);
}"""
OUTPUTS = """() => window.jupyterapp.shell.currentWidget.content.widgets
    .filter(cell => cell.model.type === "code").map(cell => JSON.stringify(cell.model.outputs.toJSON())).join("\\n")"""


@pytest.fixture
def chapter(lab: Lab, request: pytest.FixtureRequest) -> Path:
    """The first chapter's release in the test's own folder, reduced to the cells that write files."""
    folder: Path = lab.folder / request.node.name
    shutil.copytree(FIRST.folder, folder, ignore=shutil.ignore_patterns("build", "install", "log"))
    released = in_form(FIRST.read(), Form.RELEASED)
    writing_cells = [cell for cell in released.cells if cell.source.startswith("%%writefile")]
    released.cells = [new_code_cell("from autograder.notebook import ros\n\nros()"), *writing_cells]
    nbformat.write(released, folder / FIRST.notebook_path.name)
    return folder


def edit_file(page: Page, folder: Path) -> None:
    """Open the file in a tab of JupyterLab, type the answer over its text and save it with Ctrl-S."""
    page.evaluate(OPEN, f"{folder.name}/{FILE}")
    page.locator(".jp-FileEditor .cm-content").click()
    page.keyboard.press("Control+A")
    page.keyboard.insert_text(ANSWER)
    page.keyboard.press("Control+S")
    expect(page.locator(".jp-mod-dirty")).to_have_count(0, timeout=PATIENCE * 1000)
    assert (folder / FILE).read_text() == ANSWER


def run_all(page: Page, lab: Lab, folder: Path) -> str:
    """Open the notebook, restart its kernel, run all cells, and return their outputs."""
    lab.show(page, f"{folder.name}/{FIRST.notebook_path.name}")
    assert page.evaluate(RUN_ALL) == [1, 2, 3]
    return str(page.evaluate(OUTPUTS))


@pytest.mark.promise(
    "Running the notebook again does not overwrite what you wrote in the editor.",
    "| The cell says that your file was kept. |",
    "make lab",
)
def test_run_all_keeps_a_file_that_was_edited_in_the_editor(page: Page, lab: Lab, chapter: Path) -> None:
    run_all(page, lab, chapter)
    assert "NotImplementedError" in (chapter / FILE).read_text()
    edit_file(page, chapter)
    outputs = run_all(page, lab, chapter)
    assert (chapter / FILE).read_text() == ANSWER
    assert f"{FILE} was kept as it is" in outputs
    assert not (chapter / "ws" / REPLACED).exists()


def test_a_file_and_its_cell_that_were_both_changed_are_both_kept(page: Page, lab: Lab, chapter: Path) -> None:
    run_all(page, lab, chapter)
    edit_file(page, chapter)
    notebook = nbformat.read(chapter / FIRST.notebook_path.name, as_version=4)
    notebook.cells[-1].source = CELL
    nbformat.write(notebook, chapter / FIRST.notebook_path.name)
    outputs = run_all(page, lab, chapter)
    copy = Path("ws", REPLACED, Path(FILE).relative_to("ws")).with_suffix(".py.1")
    assert (chapter / FILE).read_text() == CELL.partition("\n")[2]
    assert (chapter / copy).read_text() == ANSWER
    assert f"{FILE} was changed outside of this cell. Its old text was copied to {copy}." in outputs


def test_the_student_interface_has_no_validate_button(page: Page, lab: Lab, chapter: Path) -> None:
    lab.show(page, f"{chapter.name}/{FIRST.notebook_path.name}")
    expect(page.locator(".jp-NotebookPanel-toolbar")).to_be_visible(timeout=PATIENCE * 1000)
    assert page.evaluate("() => window.jupyterapp.hasPlugin('@jupyterlab/notebook-extension:tracker')")
    for plugin in ("validate-assignment", "create-assignment"):
        assert not page.evaluate("name => window.jupyterapp.hasPlugin(`@jupyter/nbgrader:${name}`)", plugin)
    expect(page.get_by_text("Validate", exact=True)).to_have_count(0)
    expect(page.get_by_text("Create Assignment", exact=True)).to_have_count(0)
