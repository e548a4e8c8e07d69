"""What a student does in JupyterLab: nothing that was written is lost, and no button praises what is unsolved."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from autograder.course import Form, chapters, in_form
from autograder.course.sync import write_notebook
from tests.browser.jupyter import PATIENCE, Lab, lab

__all__ = ["lab"]

pytestmark = [pytest.mark.browser, pytest.mark.slow]

FIRST = next(chapter for chapter in chapters() if chapter.assignment == "00_welcome")
FILE = "ws/src/first_robot/first_robot/square.py"
ANSWER = "# written in the editor\n"
RESTART_AND_RUN = """async () => {
    const panel = window.jupyterapp.shell.currentWidget;
    await panel.sessionContext.session.kernel.restart();
    const cells = panel.content.widgets.filter(cell => cell.model.type === "code"
        && /^(%%writefile|from autograder)/.test(cell.model.sharedModel.source));
    for (const cell of cells) {
        panel.content.activeCellIndex = panel.content.widgets.indexOf(cell);
        await window.jupyterapp.commands.execute("notebook:run-cell");
    }
    return cells.length;
}"""
OUTPUTS = """() => JSON.stringify(window.jupyterapp.shell.currentWidget.content.widgets
    .filter(cell => cell.model.type === "code").map(cell => cell.model.outputs.toJSON()))"""
# The editor's own commands: the file is opened, changed and saved as a student does it.
EDIT = """async ([path, text]) => {
    const commands = window.jupyterapp.commands;
    const editor = await commands.execute("docmanager:open", {path, factory: "Editor"});
    await editor.context.ready;
    editor.context.model.sharedModel.setSource(text);
    await editor.context.save();
    editor.dispose();
}"""


@pytest.fixture
def chapter(lab: Lab) -> Path:
    """The first chapter's release, in the folder that JupyterLab serves."""
    folder = lab.folder / FIRST.assignment
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(FIRST.folder, folder, ignore=shutil.ignore_patterns("build", "install", "log"))
    write_notebook(folder / FIRST.path.name, in_form(FIRST.read(), Form.RELEASED))
    return folder


def test_run_all_keeps_a_file_that_was_edited_in_the_editor(page: Page, lab: Lab, chapter: Path) -> None:
    name = FIRST.assignment
    lab.show(page, f"{name}/{FIRST.path.name}")
    assert page.evaluate(RESTART_AND_RUN) >= 2
    stub = (chapter / FILE).read_text()
    page.evaluate(EDIT, [f"{name}/{FILE}", ANSWER])
    assert (chapter / FILE).read_text() == ANSWER != stub

    lab.show(page, f"{name}/{FIRST.path.name}")
    page.evaluate(RESTART_AND_RUN)
    assert (chapter / FILE).read_text() == ANSWER
    assert f"{FILE} was kept as it is" in json.dumps(json.loads(page.evaluate(OUTPUTS)))


def test_a_student_has_no_button_that_praises_an_unsolved_notebook(page: Page, lab: Lab, chapter: Path) -> None:
    lab.show(page, f"{chapter.name}/{FIRST.path.name}")
    expect(page.locator(".jp-NotebookPanel-toolbar")).to_be_visible(timeout=PATIENCE * 1000)
    assert page.evaluate("() => window.jupyterapp.hasPlugin('@jupyterlab/notebook-extension:tracker')")
    for plugin in ("validate-assignment", "create-assignment"):
        assert not page.evaluate("name => window.jupyterapp.hasPlugin(`@jupyter/nbgrader:${name}`)", plugin)
    expect(page.get_by_text("Validate", exact=True)).to_have_count(0)
    expect(page.get_by_text("Create Assignment", exact=True)).to_have_count(0)
