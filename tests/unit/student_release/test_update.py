"""An update writes a later release, and keeps all that the student wrote."""

from __future__ import annotations

from pathlib import Path

import nbformat
import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.author.student_release import read_manifest, update_release, write_manifest
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


def write_release(folder: Path, files: dict[str, str], cells: dict[str, str], version: str) -> Path:
    """Write a release of some files and one notebook."""
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    nbformat.write(
        new_notebook(cells=[new_markdown_cell(text, id=id) for id, text in cells.items()]), folder / NOTEBOOK
    )
    write_manifest(folder, version, "")
    return folder


@pytest.fixture
def release(tmp_path: Path) -> Path:
    return write_release(tmp_path / "course", FIRST, CELLS, "1")


@pytest.fixture
def newer_release(tmp_path: Path) -> Path:
    files = {name: f"{text}, mended" for name, text in FIRST.items() if "gone" not in name and "03_" not in name}
    cells = {"title": "# Nodes", "new": "a hint", "old": "no mistake", "exercise": "# YOUR CODE HERE, please"}
    return write_release(tmp_path / "newer", {**files, "sim/added.py": "new"}, cells, "2")


def read(release: Path) -> NotebookNode:
    return nbformat.read(release / NOTEBOOK, as_version=4)


def write(release: Path, answer: str) -> None:
    """Act like a student: answer the exercise, add a cell, run one."""
    notebook = read(release)
    notebook.cells[2].source = answer
    notebook.cells.insert(1, new_code_cell("1 + 1", id="own", execution_count=1))
    nbformat.write(notebook, release / NOTEBOOK)
    (release / GIVEN).write_text("a student's")
    (release / "chapters/02_nodes/ws/src/robot/more.py").write_text("a student's")


@pytest.mark.promise("The command replaces everything that they have not changed, down to single cells of a notebook,")
def test_unchanged_files_become_those_of_the_later_release(release: Path, newer_release: Path) -> None:
    update_release(release, newer_release)
    for name in read_manifest(newer_release).files:
        assert (release / name).read_bytes() == (newer_release / name).read_bytes(), name
    assert not (release / "sim/gone.py").exists()
    assert read_manifest(release).version == "2"


@pytest.mark.promise(
    "What you wrote in `chapters` stays as it is.",
    "It keeps files and cells in `chapters` that they wrote.",
    "The command lists each file there that it did not update",
)
def test_files_and_cells_that_a_student_wrote_are_kept(release: Path, newer_release: Path) -> None:
    write(release, "my answer")
    update = update_release(release, newer_release)
    assert (update.skipped, update.backups) == ([GIVEN], {})
    assert NOTEBOOK in update.written
    assert [(cell.id, cell.source) for cell in read(release).cells] == [
        ("title", "# Nodes"),
        ("new", "a hint"),
        ("own", "1 + 1"),
        ("old", "no mistake"),
        ("exercise", "my answer"),
    ]
    assert (release / GIVEN).read_text() == (release / "chapters/02_nodes/ws/src/robot/more.py").read_text()
    assert (release / "chapters/02_nodes/ws/src/robot/node.py").read_text() == "to do, mended"


def test_kept_files_and_cells_are_kept_at_the_next_update(release: Path, newer_release: Path) -> None:
    write(release, "my answer")
    update_release(release, newer_release)
    before = [cell.source for cell in read(release).cells]
    assert update_release(release, newer_release).skipped == [GIVEN]
    assert [cell.source for cell in read(release).cells] == before


@pytest.mark.promise(
    "your version is kept with the suffix `.yours`", "Elsewhere, it keeps a file that they changed beside the new one."
)
def test_a_changed_file_of_the_course_is_set_aside(release: Path, newer_release: Path) -> None:
    (release / "sim/world.py").write_text("mine")
    (release / "sim/world.py.yours").write_text("of the update before")
    update = update_release(release, newer_release)
    assert update.backups == {"sim/world.py": "sim/world.py.yours1"}
    assert (release / "sim/world.py").read_text() == "one, mended"
    assert (release / "sim/world.py.yours").read_text() == "of the update before"
    assert (release / "sim/world.py.yours1").read_text() == "mine"
    assert "sim/world.py" in update.written
    assert not update_release(release, newer_release).written


def test_a_chapter_that_is_missing_in_the_later_release_stays(release: Path, newer_release: Path) -> None:
    update_release(release, newer_release)
    other = "chapters/03_interfaces/notes.md"
    assert (release / other).is_file()
    assert other in read_manifest(release).files  # a release after that can still update it


def test_an_older_release_and_a_folder_that_is_not_a_release_are_rejected(
    release: Path, newer_release: Path, tmp_path: Path
) -> None:
    with pytest.raises(UsageError, match="has version 1, but the release here is newer, 2"):
        update_release(newer_release, release)
    with pytest.raises(UsageError, match="is not a release of the course"):
        update_release(release, tmp_path)
