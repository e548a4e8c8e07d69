"""A cut hides the part of a file that a student writes between two named lines."""

from __future__ import annotations

from pathlib import Path

import pytest
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_notebook

from autograder import course_paths
from autograder.author.course.cells import copied_file
from autograder.author.course.exceptions import CourseError
from autograder.author.course.forms import Form, in_form
from autograder.author.course.solution_markers import mark_lines, strip_markers
from autograder.course_paths import Course

MANIFEST = """<package>
  <name>a</name>
  <version>1</version>
  <export>
    <build_type>b</build_type>
  </export>
</package>
"""


def test_the_lines_between_two_lines_are_marked_with_their_indentation() -> None:
    marked = mark_lines(MANIFEST, [("<package>", "<export>"), ("<export>", "</export>")])
    assert marked.splitlines()[:5] == [
        "<package>",
        "  # BEGIN SOLUTION",
        "  <name>a</name>",
        "  <version>1</version>",
        "  # END SOLUTION",
    ]
    assert marked.count("BEGIN SOLUTION") == 2
    assert strip_markers(marked) == MANIFEST


def test_empty_lines_name_the_start_and_the_end_of_the_file() -> None:
    assert mark_lines("a\nb\n", [("", "")]) == "# BEGIN SOLUTION\na\nb\n# END SOLUTION\n"
    assert mark_lines("a\nb\n", [("a", "")]) == "a\n# BEGIN SOLUTION\nb\n# END SOLUTION\n"


@pytest.mark.parametrize(
    ("text", "cuts", "message"),
    [
        (MANIFEST, [("<parcel>", "")], "the line '<parcel>' occurs 0 times"),
        ("a\na\nb\n", [("a", "")], "the line 'a' occurs 2 times"),
        ("a\nb\n", [("a", "b")], "no text to hide"),
        ("a\nb\nc\n", [("c", "a")], "no text to hide"),
        ("a\nb\nc\nd\n", [("a", "d"), ("b", "")], "nested parts"),
        ("# BEGIN SOLUTION\na\n", [("", "")], "contains solution markers"),
    ],
)
def test_a_cut_whose_lines_are_not_found_is_an_error(text: str, cuts: list[tuple[str, str]], message: str) -> None:
    with pytest.raises(CourseError, match=message):
        mark_lines(text, cuts)


def _cell(**course: object) -> NotebookNode:
    return new_code_cell("", metadata={"course": {"source": "a/b.xml", "target": "ws/b.xml", **course}})


def test_a_cell_is_cut_by_its_metadata_and_its_release_contains_no_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    (tmp_path / "solutions" / "a").mkdir(parents=True)
    (tmp_path / "solutions" / "a" / "b.xml").write_text(MANIFEST)
    cell = _cell(cut=[["<package>", "</package>"]])
    source = copied_file(cell)
    assert source is not None
    cell.source = source.expected_text()
    cell.metadata["nbgrader"] = {
        **{"grade": False, "locked": False, "solution": True, "task": False},
        **{"grade_id": "b", "schema_version": 3},
    }
    released = in_form(new_notebook(cells=[cell]), Form.RELEASED).cells[0].source
    assert released.startswith("%%writefile ws/b.xml\n<package>\n  # YOUR CODE HERE\n")
    assert "<name>" not in released


@pytest.mark.parametrize(
    ("course", "message"),
    [
        ({"cut": "a"}, "`cut` must be a list, not a string"),
        ({"cut": [["a"]]}, r"`cut\[0\]` needs 2 entries, but has 1"),
        ({"cut": [["a", 1]]}, r"`cut\[0\]\[1\]` must be a string, not a number: put it in quotes"),
        ({"parts": {"main": ["a"]}, "hide": ["main"]}, r"`parts.main` needs 2 entries, but has 1"),
        ({"parts": {"main": ["a", "b"]}}, "`course` has `parts`, but no `hide`"),
        ({"cut": [["a", "b"]], "hide": ["main"]}, "a cell hides functions by `hide` or lines by `cut`, not both"),
    ],
)
def test_invalid_metadata_for_cuts_are_an_error(course: dict[str, object], message: str) -> None:
    with pytest.raises(CourseError, match=message):
        copied_file(_cell(**course))
