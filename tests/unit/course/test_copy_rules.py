"""A reference file that is copied to the workspace has the same place there as in the reference."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from nbformat import NotebookNode

from autograder import course_paths
from autograder.author.course.copy_rules import target_findings
from autograder.author.course.sync import chapters
from autograder.course_paths import Course

from .notebooks import code, notebook, prose, solution

SOURCE, TARGET = "guard/guard/watcher.py", "ws/src/guard/guard/watcher.py"
TYPO = "ws/src/guard/guard/wacher.py"
SENTENCE = f"the target `{{}}` does not match its source {SOURCE}: did you mean `{TARGET}`?"


@pytest.fixture
def solutions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    (tmp_path / "solutions/guard/guard").mkdir(parents=True)
    (tmp_path / "solutions" / SOURCE).write_text("")


def copying(target: str, source: str = SOURCE, **metadata: Any) -> NotebookNode:
    return notebook(code("", "watcher", course={"source": source, "target": target}, **metadata))


def messages(notebook: NotebookNode) -> list[tuple[str | None, str]]:
    return [(finding.cell, finding.message) for finding in target_findings("small.ipynb", notebook)]


@pytest.mark.usefixtures("solutions")
@pytest.mark.parametrize("target", [TYPO, "ws/guard/guard/watcher.py"])
def test_a_target_that_does_not_match_its_source_is_found(target: str) -> None:
    found = messages(copying(target, nbgrader=solution("watcher")))
    assert found == [("watcher", SENTENCE.format(target))]


@pytest.mark.usefixtures("solutions")
def test_a_target_that_matches_its_source_is_accepted() -> None:
    assert messages(copying(TARGET, nbgrader=solution("watcher"))) == []


@pytest.mark.usefixtures("solutions")
def test_a_given_file_may_be_copied_to_a_folder_outside_the_workspace() -> None:
    assert messages(copying("printed/watcher.py")) == []
    assert messages(notebook(prose("# Title", "title"), given={"printed/watcher.py": SOURCE})) == []


@pytest.mark.usefixtures("solutions")
def test_a_given_file_of_the_workspace_is_where_the_reference_has_it() -> None:
    assert messages(notebook(prose("# Title", "title"), given={TARGET: SOURCE})) == []
    assert messages(notebook(prose("# Title", "title"), given={TYPO: SOURCE})) == [(None, SENTENCE.format(TYPO))]


@pytest.mark.usefixtures("solutions")
def test_no_target_is_proposed_for_a_source_that_the_reference_lacks() -> None:
    assert messages(copying(TARGET, "guard/guard/wacher.py", nbgrader=solution("watcher"))) == []


def test_every_target_of_the_course_matches_its_source() -> None:
    assert [found for chapter in chapters() for found in messages(chapter.read())] == []
