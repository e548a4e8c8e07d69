"""An update writes a later release, and keeps all that the student wrote."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.author.bundle import read_manifest, update_bundle, write_manifest
from autograder.exceptions import UsageError

NOTEBOOK = "chapters/02_nodes/02_nodes.ipynb"
GIVEN = "chapters/02_nodes/ws/src/robot/setup.py"
FIRST = {
    "sim/world.py": "one",
    "sim/gone.py": "one",
    GIVEN: "given",
    "chapters/02_nodes/ws/src/robot/node.py": "to do",
    "chapters/03_interfaces/notes.md": "a chapter that a later release does not hold",
}
CELLS = {"title": "# Nodes", "old": "a mistake", "exercise": "# YOUR CODE HERE", "dropped": "of no use"}


def release(folder: Path, files: dict[str, str], cells: dict[str, str], version: str) -> Path:
    """Write a bundle of some files and one notebook."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    nbformat.write(
        new_notebook(cells=[new_markdown_cell(text, id=id) for id, text in cells.items()]), folder / NOTEBOOK
    )
    write_manifest(folder, version, "")
    return folder


@pytest.fixture
def bundle(tmp_path: Path) -> Path:
    return release(tmp_path / "course", FIRST, CELLS, "1")


@pytest.fixture
def newer(tmp_path: Path) -> Path:
    files = {name: f"{text}, mended" for name, text in FIRST.items() if "gone" not in name and "03_" not in name}
    cells = {"title": "# Nodes", "new": "a hint", "old": "no mistake", "exercise": "# YOUR CODE HERE, please"}
    return release(tmp_path / "newer", {**files, "sim/added.py": "new"}, cells, "2")


def read(bundle: Path) -> NotebookNode:
    return nbformat.read(bundle / NOTEBOOK, as_version=4)


def write(bundle: Path, answer: str) -> None:
    """Do what a student does: answer the exercise, add a cell, run one."""
    notebook = read(bundle)
    notebook.cells[2].source = answer
    notebook.cells.insert(1, new_code_cell("1 + 1", id="own", execution_count=1))
    nbformat.write(notebook, bundle / NOTEBOOK)
    (bundle / GIVEN).write_text("a student's")
    (bundle / "chapters/02_nodes/ws/src/robot/more.py").write_text("a student's")


@pytest.mark.promise("The command replaces everything that they have not changed, down to single cells of a notebook,")
def test_unchanged_files_become_those_of_the_later_release(bundle: Path, newer: Path) -> None:
    update_bundle(bundle, newer)
    for name in read_manifest(newer).files:
        assert (bundle / name).read_bytes() == (newer / name).read_bytes(), name
    assert not (bundle / "sim/gone.py").exists()
    assert read_manifest(bundle).version == "2"


@pytest.mark.promise(
    "What you wrote in `chapters` stays as it is.",
    "It keeps files and cells in `chapters` that they wrote.",
    "The command lists each file there that it did not update",
)
def test_files_and_cells_that_a_student_wrote_are_kept(bundle: Path, newer: Path) -> None:
    write(bundle, "my answer")
    done = update_bundle(bundle, newer)
    assert (done.kept, done.set_aside) == ([GIVEN], {})
    assert NOTEBOOK in done.written
    assert [(cell.id, cell.source) for cell in read(bundle).cells] == [
        ("title", "# Nodes"),
        ("new", "a hint"),
        ("own", "1 + 1"),
        ("old", "no mistake"),
        ("exercise", "my answer"),
    ]
    assert (bundle / GIVEN).read_text() == (bundle / "chapters/02_nodes/ws/src/robot/more.py").read_text()
    assert (bundle / "chapters/02_nodes/ws/src/robot/node.py").read_text() == "to do, mended"


def test_kept_files_and_cells_are_kept_at_the_next_update(bundle: Path, newer: Path) -> None:
    write(bundle, "my answer")
    update_bundle(bundle, newer)
    before = [cell.source for cell in read(bundle).cells]
    assert update_bundle(bundle, newer).kept == [GIVEN]
    assert [cell.source for cell in read(bundle).cells] == before


@pytest.mark.promise(
    "your version is kept with the suffix `.yours`", "Elsewhere, it keeps a file that they changed beside the new one."
)
def test_a_changed_file_of_the_course_is_set_aside(bundle: Path, newer: Path) -> None:
    (bundle / "sim/world.py").write_text("mine")
    (bundle / "sim/world.py.yours").write_text("of the update before")
    done = update_bundle(bundle, newer)
    assert done.set_aside == {"sim/world.py": "sim/world.py.yours1"}
    assert (bundle / "sim/world.py").read_text() == "one, mended"
    assert (bundle / "sim/world.py.yours").read_text() == "of the update before"
    assert (bundle / "sim/world.py.yours1").read_text() == "mine"
    assert "sim/world.py" in done.written
    assert not update_bundle(bundle, newer).written


def test_a_chapter_that_is_missing_in_the_later_release_stays(bundle: Path, newer: Path) -> None:
    update_bundle(bundle, newer)
    other = "chapters/03_interfaces/notes.md"
    assert (bundle / other).is_file()
    assert other in read_manifest(bundle).files  # a release after that can still update it


def test_an_older_release_and_a_folder_that_is_not_a_release_are_rejected(
    bundle: Path, newer: Path, tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match="has version 1, but the release here is newer, 2"):
        update_bundle(newer, bundle)
    with pytest.raises(UsageError, match="is not a release of the course"):
        update_bundle(bundle, tmp_path)
