"""A notebook can be run again: twice in one kernel, and in a new kernel on the folder that was used."""

from __future__ import annotations

import copy
import re
from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode

from autograder.author.course.execute import execute, working_copy
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter, chapters
from autograder.ros.domains import Domain
from tests.notebooks.outputs import text_of

# Parts of an output on which the text around a cell relies: the error, the number of passed checks, what is missing.
RELIED_ON = re.compile(
    r"\b[A-Z]\w*(?:Error|Exception)\b|\d+ of \d+ visible checks passed|No executable found|exit status [1-9]\d*|"
    r"Package '?\w*'? ?not found|process has finished cleanly"
)


def relied_on_parts(cell: NotebookNode) -> set[str]:
    """Return the parts of a cell's output on which the text may rely."""
    return set(RELIED_ON.findall(text_of([cell])))


def twice(notebook: NotebookNode) -> NotebookNode:
    """Return a notebook that contains each cell twice."""
    doubled = copy.deepcopy(notebook)
    again = copy.deepcopy(notebook.cells)
    for cell in again:
        cell.id = f"{cell.id}-again"
    doubled.cells += again
    return doubled


@pytest.mark.nightly
@pytest.mark.timeout(2400)
@pytest.mark.parametrize("chapter", chapters(), ids=lambda chapter: chapter.assignment)
def test_a_notebook_that_is_run_again_shows_the_same(chapter: Chapter, tmp_path: Path) -> None:
    notebook = in_form(chapter.read(), Form.SOURCE)
    one_kernel, new_kernel = twice(notebook), copy.deepcopy(notebook)
    with working_copy(chapter.folder) as folder, Domain() as domain:
        for name, executed in (("one_kernel", one_kernel), ("new_kernel", new_kernel)):
            failure = execute(executed, folder, 400, domain.number)
            nbformat.write(executed, tmp_path / f"{name}.ipynb")
            assert failure is None, failure
    count = len(notebook.cells)
    first = {cell.id: relied_on_parts(cell) for cell in one_kernel.cells[:count]}
    assert any(first.values())
    assert {cell.id.removesuffix("-again"): relied_on_parts(cell) for cell in one_kernel.cells[count:]} == first
    assert {cell.id: relied_on_parts(cell) for cell in new_kernel.cells} == first
