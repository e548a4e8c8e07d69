"""A solution cell and its file in solutions/ have the same text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from autograder import course_paths
from autograder.author.course.exceptions import CourseError
from autograder.author.course.sync import Chapter, chapters, find_outdated, sync_chapter
from autograder.course_paths import Course

from .notebooks import chapter, code, notebook, prose, solution

NODE = 'def main():\n    """Run."""\n    return 0\n'
CELL: dict[str, Any] = {"source": "pkg/node.py", "target": "ws/src/pkg/node.py", "hide": ["main"]}


@pytest.fixture(autouse=True)
def solutions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    folder = tmp_path / "solutions"
    (folder / "pkg").mkdir(parents=True)
    (folder / "pkg/node.py").write_text("# Copyright 2026 Us\n\n" + NODE)
    (folder / "pkg/setup.cfg").write_text("[develop]\n")
    return folder


def small(tmp_path: Path, **course: Any) -> Chapter:
    cell = code("", "node", course={**CELL, **course}, nbgrader=solution("node"))
    return chapter(tmp_path, notebook(prose("# A title", "title"), cell))


@pytest.mark.promise("`autograder course sync` writes the cells that copy it")
def test_sync_writes_the_cell_with_its_answer_marked(tmp_path: Path, solutions: Path) -> None:
    small_chapter = small(tmp_path)
    assert [finding.cell for finding in sync_chapter(small_chapter)] == ["node"]
    assert small_chapter.read().cells[1].source == (
        "%%writefile ws/src/pkg/node.py\n"
        'def main():\n    """Run."""\n    # BEGIN SOLUTION\n    return 0\n    # END SOLUTION'
    )


def test_sync_twice_changes_nothing(tmp_path: Path, solutions: Path) -> None:
    small_chapter = small(tmp_path)
    sync_chapter(small_chapter)
    before = small_chapter.notebook_path.read_bytes()
    assert sync_chapter(small_chapter) == []
    assert small_chapter.notebook_path.read_bytes() == before


def test_a_stale_cell_is_named_with_what_differs(tmp_path: Path, solutions: Path) -> None:
    small_chapter = small(tmp_path)
    sync_chapter(small_chapter)
    (solutions / "pkg/node.py").write_text(NODE.replace("return 0", "return 1"))
    (finding,) = find_outdated(small_chapter)
    assert str(finding).startswith(
        "01_small.ipynb, cell 'node': differs from solutions/pkg/node.py; run `autograder course sync`"
    )
    assert "-    return 0" in str(finding)
    assert "+    return 1" in str(finding)


def test_a_cell_that_hides_nothing_shows_the_file(tmp_path: Path, solutions: Path) -> None:
    small_chapter = small(tmp_path, hide=[])
    sync_chapter(small_chapter)
    assert small_chapter.read().cells[1].source == f"%%writefile ws/src/pkg/node.py\n{NODE}".rstrip()


def test_a_given_file_is_copied_and_compared(tmp_path: Path, solutions: Path) -> None:
    small_chapter = chapter(
        tmp_path, notebook(prose("# A title", "title"), given={"ws/src/pkg/setup.cfg": "pkg/setup.cfg"})
    )
    (missing,) = find_outdated(small_chapter)
    assert "the given file ws/src/pkg/setup.cfg is missing" in str(missing)
    sync_chapter(small_chapter)
    assert (small_chapter.folder / "ws/src/pkg/setup.cfg").read_text() == "[develop]\n"
    assert find_outdated(small_chapter) == []
    (small_chapter.folder / "ws/src/pkg/setup.cfg").write_text("[install]\n")
    (differs,) = find_outdated(small_chapter)
    assert "the given file ws/src/pkg/setup.cfg differs" in str(differs)


@pytest.mark.parametrize(
    ("course", "message"),
    [
        ({"source": "pkg/gone.py"}, "the reference has no file pkg/gone.py"),
        ({"source": "../secret"}, "the metadata are invalid: `source`: must be a relative path"),
        ({"source": "pkg/../../secret"}, "`source`: must be a relative path that stays inside its folder"),
        ({"target": "/etc/passwd"}, "`target`: must be a relative path that stays inside its folder"),
        ({"target": None}, "the metadata are invalid: `target` must be a string, not empty"),
        ({"hide": "main"}, "the metadata are invalid: `hide` must be a list, not a string"),
        ({"hied": ["main"]}, "the metadata are invalid: `course` has an unknown key `hied`: did you mean `hide`?"),
        ({"hide": ["mian"]}, "pkg/node.py: function 'mian' occurs 0 times"),
    ],
)
def test_metadata_that_sync_cannot_correct_are_an_error_and_nothing_is_written(
    tmp_path: Path, solutions: Path, course: dict[str, Any], message: str
) -> None:
    small_chapter = small(tmp_path, **course)
    before = small_chapter.notebook_path.read_bytes()
    (finding,) = find_outdated(small_chapter)
    assert message in str(finding)
    with pytest.raises(CourseError, match=r"01_small\.ipynb, cell 'node'"):
        sync_chapter(small_chapter)
    assert small_chapter.notebook_path.read_bytes() == before


def test_given_must_be_a_mapping(tmp_path: Path, solutions: Path) -> None:
    small_chapter = chapter(tmp_path, notebook(given=["pkg/setup.cfg"]))
    (finding,) = find_outdated(small_chapter)
    assert "the metadata are invalid: `given` must be a mapping, not a list" in finding.message


def test_course_metadata_must_be_a_mapping(tmp_path: Path, solutions: Path) -> None:
    small_chapter = chapter(tmp_path, notebook(code("", "odd", course="pkg/node.py")))
    (finding,) = find_outdated(small_chapter)
    assert "the metadata are invalid: `course` must be a mapping, not a string" in finding.message


def test_a_folder_without_its_notebook_is_named(tmp_path: Path) -> None:
    with pytest.raises(CourseError, match=r"01_small: the folder has no notebook 01_small\.ipynb: create it"):
        Chapter(tmp_path / "01_small").read()


@pytest.mark.parametrize("text", ["no json", "{}", '{"cells": 3}'])
def test_a_file_that_is_not_a_notebook_is_named(tmp_path: Path, text: str) -> None:
    small_chapter = chapter(tmp_path, notebook())
    small_chapter.notebook_path.write_text(text)
    with pytest.raises(CourseError, match=r"01_small\.ipynb is not a notebook"):
        small_chapter.read()


def test_two_cells_with_one_id_are_named_before_nbformat_repairs_them(tmp_path: Path) -> None:
    small_chapter = chapter(tmp_path, notebook(prose("# T", "same"), prose("text", "other")))
    small_chapter.notebook_path.write_text(small_chapter.notebook_path.read_text().replace('"other"', '"same"'))
    with pytest.raises(CourseError, match=r"each cell needs a unique id: .*'same'"):
        small_chapter.read()


def test_chapters_are_sorted_and_other_notebooks_are_ignored(tmp_path: Path) -> None:
    for name in ("02_b", "01_a"):
        chapter(tmp_path, notebook(), name)
    (tmp_path / "chapters/01_a/Untitled.ipynb").write_text("{}")
    assert [listed.assignment for listed in chapters()] == ["01_a", "02_b"]
