"""A notebook runs in three forms: the author's source, the solved form and the released form."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.author.course.execute import run_notebook
from autograder.author.course.forms import Form, in_form

from .notebooks import chapter, code, grade, notebook, prose, solution

SOLVED = "# BEGIN SOLUTION\nanswer = 42\n# END SOLUTION"


def test_the_released_form_has_the_stub_instead_of_the_answer() -> None:
    released = in_form(notebook(code(SOLVED, "s", nbgrader=solution("s"))), Form.RELEASED)
    assert "42" not in released.cells[0].source
    assert "still to be written" in released.cells[0].source


def test_the_released_form_has_no_hidden_test() -> None:
    source = "### BEGIN HIDDEN TESTS\nassert answer == 42\n### END HIDDEN TESTS"
    released = in_form(notebook(code(source, "g", nbgrader=grade("g", 1))), Form.RELEASED)
    assert "42" not in released.cells[0].source


def test_the_solved_form_is_the_answer_without_marks() -> None:
    assert in_form(notebook(code(SOLVED, "s", nbgrader=solution("s"))), Form.SOLVED).cells[0].source == "answer = 42"


def test_a_mark_scheme_is_in_the_source_only() -> None:
    scheme = "Why?\n### BEGIN MARK SCHEME\n1 point.\n### END MARK SCHEME\nHow?"
    source = notebook(prose(scheme, "q", nbgrader={**solution("q"), "solution": False, "locked": True}))
    for form in (Form.SOLVED, Form.RELEASED):
        assert in_form(source, form).cells[0].source == "Why?\nHow?"


def test_creating_a_form_does_not_change_the_source() -> None:
    source = notebook(code(SOLVED, "s", nbgrader=solution("s")))
    in_form(source, Form.RELEASED)
    assert source.cells[0].source == SOLVED


@pytest.mark.slow
def test_a_notebook_runs_beside_a_copy_of_its_files(tmp_path: Path) -> None:
    small_chapter = chapter(
        tmp_path,
        notebook(
            prose("# T", "t"),
            code("from pathlib import Path\nprint(Path('given.txt').read_text())", "read"),
            code("Path('made').touch()", "w"),
        ),
    )
    (small_chapter.folder / "given.txt").write_text("hello")
    (small_chapter.folder / "build").mkdir()
    result = run_notebook(small_chapter, report=tmp_path / "out/report.ipynb")
    assert result.ok, result.failure
    assert result.notebook.cells[1].outputs[0].text == "hello\n"
    assert not (small_chapter.folder / "made").exists()
    assert "hello" in (tmp_path / "out/report.ipynb").read_text()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("1 / 0", "ZeroDivisionError"),
        ("import warnings\nwarnings.warn('old', DeprecationWarning)", "DeprecationWarning: old"),
    ],
)
def test_an_error_and_a_warning_both_fail_and_name_their_cell(tmp_path: Path, source: str, message: str) -> None:
    small_chapter = chapter(tmp_path, notebook(code("1", "fine"), code(source, "bad"), code("2", "never")))
    result = run_notebook(small_chapter)
    assert not result.ok
    assert result.failure is not None
    assert result.failure.startswith("cell 'bad'")
    assert message in result.failure
