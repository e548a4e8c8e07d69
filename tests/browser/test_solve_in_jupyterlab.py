"""A chapter's release is solved in JupyterLab: the answers are typed in, all cells run, and the check passes.

`make test` solves one chapter; `make tour` and `make nightly` solve all. Screenshots of each chapter's pictures and of
its check are written to `.build/screenshots`.
"""

from __future__ import annotations

import base64
import io
import json
import re
import shutil
from pathlib import Path
from typing import Any

import nbformat
import pytest
from PIL import Image
from playwright.sync_api import Page

from autograder.author.course.cells import is_solution
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from tests.browser.jupyter import Lab, lab
from tests.browser.looks import Screenshots

__all__ = ["lab"]

pytestmark = pytest.mark.browser

EVERY_RUN = ("07_best_practices",)
MINUTES = 8
CHOSEN = [
    pytest.param(chapter, id=chapter.assignment, marks=[] if chapter.assignment in EVERY_RUN else [pytest.mark.nightly])
    for chapter in chapters()
]

# Focuses the cell's editor and selects its text, so that typing replaces it.
EDIT = """async id => {
    const notebook = window.jupyterapp.shell.currentWidget.content;
    const index = notebook.widgets.findIndex(cell => cell.model.id === id);
    await notebook.scrollToItem(index, "start");
    notebook.activeCellIndex = index;
    const cell = notebook.activeCell;
    await cell.ready;
    notebook.mode = "edit";
    cell.editor.focus();
    const end = cell.editor.getPositionAt(cell.model.sharedModel.source.length);
    cell.editor.setSelection({start: {line: 0, column: 0}, end});
}"""
SOURCE = """id => {
    const cells = window.jupyterapp.shell.currentWidget.content.widgets;
    return cells.find(cell => cell.model.id === id).model.sharedModel.source;
}"""
FINISHED = """() => {
    const panel = window.jupyterapp.shell.currentWidget;
    const code = panel.content.widgets.map(cell => cell.model)
        .filter(model => model.type === "code" && model.sharedModel.source.trim());
    const failed = code.some(model => model.outputs.toJSON().some(output => output.output_type === "error"));
    const idle = panel.sessionContext.session.kernel.status === "idle";
    return idle && (failed || code.every(model => model.executionCount));
}"""
SCROLL = """async id => {
    const notebook = window.jupyterapp.shell.currentWidget.content;
    await notebook.scrollToItem(notebook.widgets.findIndex(cell => cell.model.id === id), "start");
}"""
LOADED = """id => {
    const cell = window.jupyterapp.shell.currentWidget.content.widgets.find(cell => cell.model.id === id);
    return [...cell.node.querySelectorAll("img")].every(image => image.complete && image.naturalWidth > 0);
}"""
# Loaded pictures have a height, and may have moved the cell out of sight.
CENTRE = """id => {
    const cell = window.jupyterapp.shell.currentWidget.content.widgets.find(cell => cell.model.id === id);
    (cell.node.querySelector("img") ?? cell.node).scrollIntoView({block: "center"});
}"""
FITS = """id => {
    const cell = window.jupyterapp.shell.currentWidget.content.widgets.find(cell => cell.model.id === id);
    const edge = cell.node.getBoundingClientRect().right + 1;
    return [...cell.node.querySelectorAll("img")].every(image => image.getBoundingClientRect().right <= edge);
}"""
OUTPUTS = """() => JSON.stringify(window.jupyterapp.shell.currentWidget.content.widgets
    .filter(cell => cell.model.type === "code")
    .map(cell => [cell.model.id, cell.model.outputs.toJSON()]))"""


def type_in(page: Page, cell: str, text: str) -> None:
    """Replace a cell's text by pasting an answer from the keyboard."""
    page.evaluate(EDIT, cell)
    page.keyboard.insert_text(text)
    page.keyboard.press("Escape")
    assert page.evaluate(SOURCE, cell) == text


def outputs(page: Page) -> dict[str, list[dict[str, Any]]]:
    """Return the outputs of each code cell, by its id."""
    return dict(json.loads(page.evaluate(OUTPUTS)))


def photograph(page: Page, cell: str, path: Path) -> None:
    """Take a screenshot of a cell's output; all its pictures must have loaded, and fit into the cell."""
    page.evaluate(SCROLL, cell)
    page.wait_for_function(LOADED, arg=cell)
    page.evaluate(CENTRE, cell)
    page.screenshot(path=path)
    assert page.evaluate(FITS, cell)


def is_blank(picture: str) -> bool:
    """Return whether a picture, given as Base64, has hardly more than one colour."""
    with Image.open(io.BytesIO(base64.b64decode(picture))) as image:
        return len(image.convert("RGB").resize((64, 64)).getcolors(64 * 64) or ()) < 8


@pytest.mark.promise("Open a chapter in JupyterLab and run it from the top.", "Students start it with `make lab`.")
@pytest.mark.slow
@pytest.mark.timeout(60 * MINUTES + 120)
@pytest.mark.parametrize("chapter", CHOSEN)
def test_a_chapters_release_is_solved_in_jupyterlab(
    page: Page, lab: Lab, screenshots: Screenshots, chapter: Chapter
) -> None:
    name = chapter.assignment
    shutil.copytree(chapter.folder, lab.folder / name, ignore=shutil.ignore_patterns("build", "install", "log"))
    nbformat.write(in_form(chapter.read(), Form.RELEASED), lab.folder / name / chapter.notebook_path.name)

    lab.show(page, f"{name}/{chapter.notebook_path.name}")
    solved = [cell for cell in in_form(chapter.read(), Form.SOLVED).cells if is_solution(cell)]
    for cell in solved:
        type_in(page, cell.id, cell.source)
    lab.run_all(page)
    page.wait_for_function(FINISHED, timeout=60_000 * MINUTES, polling=500)

    cell_outputs = outputs(page)
    errors = [output for cell in cell_outputs.values() for output in cell if output["output_type"] == "error"]
    assert not errors, errors[0]["traceback"]
    # Jupyter shows an exception that ends a thread of the kernel, and continues.
    streams = ["".join(output.get("text", "")) for cell in cell_outputs.values() for output in cell]
    assert not [stream for stream in streams if "Exception in thread" in stream]
    text = json.dumps(cell_outputs, ensure_ascii=False)
    counts = re.findall(r"(\d+) of (\d+) visible checks passed", text)
    assert counts
    assert all(passed == total for passed, total in counts), counts
    pictures_by_cell = {
        cell: [output["data"]["image/png"] for output in outputs_of_cell if "image/png" in output.get("data", {})]
        for cell, outputs_of_cell in cell_outputs.items()
    }
    assert not any(is_blank(picture) for pictures in pictures_by_cell.values() for picture in pictures)
    figures = [cell.id for cell in chapter.read().cells if cell.cell_type == "markdown" and "](figures/" in cell.source]
    checks = [
        cell for cell, outputs_of_cell in cell_outputs.items() if "visible checks passed" in json.dumps(outputs_of_cell)
    ]
    page.set_viewport_size({"width": 1100, "height": 1100})
    for cell in (*figures[:1], *[cell for cell, pictures in pictures_by_cell.items() if pictures][:3], checks[-1]):
        photograph(page, cell, screenshots.folder / f"tour-{name}-{cell}.png")
    page.close()
