"""Only students with full marks get other correct answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.report.export import write
from autograder.report.other_answers import INDEX_FILE, other_answers
from autograder.result.model import Result
from autograder.suite import suites

MakeResult = Callable[..., Result]


@pytest.mark.promise(
    "autograder export results --format other_answers --out pages` writes a page with two other correct answers"
)
def test_a_page_is_written_for_full_marks_only(
    make_result: MakeResult, broken_result: Result, ungraded_result: Result, tmp_path: Path
) -> None:
    partial_marks = make_result()
    assert partial_marks.score < partial_marks.max_score
    checks = tuple(replace(check, points=check.max_points) for check in partial_marks.checks)
    full_marks = replace(partial_marks, student="dora", checks=checks)
    assert full_marks.score == full_marks.max_score
    out = write([partial_marks, broken_result, ungraded_result, full_marks], "other_answers", tmp_path / "out")
    (page,) = (path for path in out.rglob("*") if path.is_file())
    assert page == out / "dora" / "other_answers.html"
    html = page.read_text(encoding="utf-8")
    assert html.count("<h2>Answer ") == 2
    assert "class State(Enum):" in html
    assert "numpy evaluates all beams at once" in html
    assert "dora" not in html


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_each_graded_chapter_shows_two_answers_with_what_differs(assignment: str) -> None:
    answers = other_answers(assignment)
    assert len(answers) == 2
    assert all(len(answer.difference.split()) > 10 and answer.files for answer in answers)
    assert not any("Licensed under" in text for answer in answers for path, text in answer.files if path[-3:] == ".py")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "02_nodes has no other answers to show: .*shown.yaml does not exist"),
        ("[states", "cannot be read as YAML"),
        ("states\n", "for each variant, write its name, a colon and how it differs"),
        ("states: 3\n", "for each variant, write its name, a colon and how it differs"),
        ("stats: It has states.\n", "names 'stats', which is not a variant; the variants are: states"),
    ],
)
def test_a_mistake_in_the_list_of_shown_answers_is_named(
    text: str | None, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    variants = tmp_path / "ch02_nodes" / "variants"
    (variants / "states").mkdir(parents=True)
    if text is not None:
        (variants / INDEX_FILE).write_text(text)
    monkeypatch.setitem(vars(course_paths), "CHECKS", tmp_path)  # `setattr` would leave the computed value there
    with pytest.raises(UsageError, match=message):
        other_answers("02_nodes")
