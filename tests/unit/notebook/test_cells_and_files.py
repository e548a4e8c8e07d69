"""`check` says where a file of an answer differs from the cell that writes it."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from autograder.notebook.cells_and_files import differences
from autograder.notebook.written_record import RECORD, digest
from autograder.submission.exercise_stubs import CODE_STUB

FILE = "src/robot/robot/node.py"
STUB = f"def main():\n    {CODE_STUB}\n"
DIFFERS = "ws/src/robot/robot/node.py differs from the cell that writes it. The file counts"


def write(
    folder: Path, cell: str | None, file: str | None, last: str | None = None, *, saved_later: bool = True
) -> tuple[str, ...]:
    """Make a chapter's folder: the saved cell, the file, and what a cell wrote last. Return the notices."""
    workspace = folder / "ws"
    (workspace / "src/robot/robot").mkdir(parents=True)
    source = [] if cell is None else [{"cell_type": "code", "source": f"%%writefile ws/{FILE}\n{cell}"}]
    notebook = folder / "02_nodes.ipynb"
    notebook.write_text(json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": source}))
    if file is not None:
        (workspace / FILE).write_text(file)
        os.utime(workspace / FILE, (1000, 1000))
    if last is not None:
        (workspace / RECORD).write_text(json.dumps({FILE: digest(last)}))
    os.utime(notebook, (1001, 1001) if saved_later else (999, 999))
    return differences("02_nodes", workspace, ("robot",))


@pytest.mark.parametrize(
    ("cell", "file", "last", "saved_later"),
    [
        pytest.param("a = 1", "a = 1\n", "a = 1\n", True, id="the cell was run"),
        pytest.param("a = 1\r\n", "\ufeffa = 1\n\n", None, True, id="other line ends"),
        pytest.param(STUB, "a = 1\n", STUB, True, id="written in the editor over the stub"),
        pytest.param(STUB, "a = 1\n", None, True, id="written in the editor, no cell was run"),
        pytest.param("a = 0", "a = 1\n", "a = 1\n", False, id="the notebook is not saved yet"),
        pytest.param(None, "a = 1\n", None, True, id="no cell"),
        pytest.param(STUB, None, None, True, id="nothing written"),
    ],
)
def test_nothing_is_reported_if_the_file_is_intended(
    tmp_path: Path, cell: str | None, file: str | None, last: str | None, saved_later: bool
) -> None:
    assert write(tmp_path, cell, file, last, saved_later=saved_later) == ()


@pytest.mark.promise(
    "If a cell and its file differ, `check(...)` and the feedback say so.",
    '| "differs from the cell that writes it" |',
)
@pytest.mark.parametrize(
    ("cell", "file", "last", "saved_later"),
    [
        pytest.param("a = 0", "a = 1\n", "a = 0\n", True, id="finished in the editor"),
        pytest.param("a = 0", "a = 1\n", "a = 0\n", False, id="finished in the editor, notebook not saved"),
        pytest.param(STUB, "a = 1\n", "a = 0\n", False, id="finished in the editor, draft not saved"),
        pytest.param("a = 1", "a = 0\n", "a = 0\n", True, id="newer cell that was never run"),
        pytest.param("a = 1", "a = 0\n", None, True, id="no record"),
        pytest.param("a = 1", STUB, STUB, True, id="answer in the cell, stub in the file"),
    ],
)
def test_a_file_that_differs_from_its_cell_is_named(
    tmp_path: Path, cell: str, file: str, last: str | None, saved_later: bool
) -> None:
    (notice,) = write(tmp_path, cell, file, last, saved_later=saved_later)
    assert notice.startswith(DIFFERS)


def test_a_cell_that_was_never_run_is_named(tmp_path: Path) -> None:
    assert write(tmp_path, "a = 1", None) == ("ws/src/robot/robot/node.py is missing: run the cell that writes it.",)


@pytest.mark.parametrize("file", [None, "a = 0\n"])
def test_a_file_of_a_later_exercise_is_not_compared(tmp_path: Path, file: str | None) -> None:
    assert write(tmp_path, "a = 1", file) != ()
    assert differences("02_nodes", tmp_path / "ws", ("robot",), later=(f"ws/{FILE}",)) == ()


def test_a_package_that_is_not_checked_and_a_broken_notebook_give_no_notice(tmp_path: Path) -> None:
    write(tmp_path, "a = 1", "a = 0\n")
    assert differences("02_nodes", tmp_path / "ws", ("other",)) == ()
    (tmp_path / "02_nodes.ipynb").write_text("{")
    assert differences("02_nodes", tmp_path / "ws", ("robot",)) == ()
