"""Reports in the notebook are plain, escaped sentences, and no program runs while the notebook is graded."""

from __future__ import annotations

from pathlib import Path

import pytest
from nbformat.v4 import new_code_cell, new_output
from nbgrader.utils import determine_grade

from autograder.exceptions import UsageError
from autograder.notebook import check, drive, grade
from autograder.notebook.checking import CheckReport
from autograder.notebook.notices import Notice
from autograder.result.model import CheckResult
from autograder.suite import Check, Outcome, Visibility
from sim.grading import GRADING_VARIABLE

GRADED = {"grade": True, "solution": False, "locked": True, "grade_id": "g", "schema_version": 3}


def _line(title: str, outcome: Outcome, message: str = "") -> CheckResult:
    check = Check("id", title, 1.0, "graph", Visibility.VISIBLE, ("look <here>",), "https://docs.ros.org", ())
    return CheckResult.of(check, outcome, message)


LINES = (
    _line("It starts.", Outcome.PASSED),
    _line("It turns <left>.", Outcome.FAILED, "it drove & drove"),
    _line("It stops.", Outcome.NOT_CHECKED),
)


def test_a_notice_of_trouble_is_shown_unless_the_requested_part_passed() -> None:
    notice = Notice("There is no package lab.")

    def shows_notice(lines: tuple[CheckResult, ...], part: str) -> set[bool]:
        report = CheckReport("09_assessment", lines, notice, part=part)
        return {notice.sentence in text for text in (repr(report), report._repr_html_())}

    assert shows_notice(LINES[:1], "question 1") == {False}
    assert shows_notice(LINES, "question 1") == shows_notice(LINES[:1], "") == {True}


def test_a_report_counts_and_explains_on_a_terminal() -> None:
    text = repr(CheckReport("02_nodes", LINES))
    assert "✔ passed      It starts." in text
    assert "✘ failed      It turns <left>." in text
    assert text.count("    hint 1: look <here>") == 1  # only a check that failed has hints and a page to read
    assert text.endswith("02_nodes: 1 of 3 visible checks passed.")
    assert text.count("https://docs.ros.org") == 1


def test_output_of_a_program_is_escaped_in_a_notebook() -> None:
    html = CheckReport("02_nodes", LINES, Notice("<script>", "a < b"))._repr_html_()
    assert "&lt;script&gt;" in html
    assert "<script>" not in html
    assert "it drove &amp; drove" in html
    assert html.count("look &lt;here&gt;") == 1


def test_consequences_are_lines_below_their_cause() -> None:
    def line(id: str, outcome: Outcome, *after: str) -> CheckResult:
        check = Check(id, f"It is <{id}>.", 1.0, "g", Visibility.VISIBLE, ("look",), None, (), (), after)
        return CheckResult.of(check, outcome, f"{id} is wrong")

    lines = line("a", Outcome.FAILED), line("b", Outcome.FAILED, "a"), line("c", Outcome.NOT_CHECKED, "b")
    report = CheckReport("02_nodes", (*lines, line("d", Outcome.NOT_CHECKED, "a"), line("e", Outcome.PASSED)))
    assert (
        repr(report)
        == """\
✘ failed      It is <a>.
    a is wrong
    hint 1: look
    These also failed. Fix the one above first, then run again:
    ✘ failed      It is <b>.
    Not checked: It is <c>. It is <d>.
✔ passed      It is <e>.
    e is wrong

02_nodes: 1 of 5 visible checks passed."""
    )
    html = report._repr_html_()
    assert "<summary>These also failed. Fix the one above first, then run again: 1</summary>" in html
    assert "Not checked: It is &lt;c&gt;. It is &lt;d&gt;.</div>" in html
    assert html.count("not checked") == 0


def test_a_report_passes_when_every_check_does() -> None:
    assert CheckReport("02_nodes", LINES[:1]).passed
    assert not CheckReport("02_nodes", LINES).passed


def test_a_notice_shows_a_sentence_and_its_detail() -> None:
    assert repr(Notice("Nothing moves.", "line 3")) == "Nothing moves.\nline 3"
    assert repr(Notice("Nothing moves.")) == "Nothing moves."


def test_no_drive_and_no_check_runs_while_a_notebook_is_graded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(GRADING_VARIABLE, "1")
    for report in (check("02_nodes", "/no/where"), drive("a", "b", workspace="/no/where")):
        assert isinstance(report, Notice)


def test_the_locked_cell_gives_no_points_in_the_kernel() -> None:
    assert "after you have submitted" in grade("02_nodes", "graph").sentence


def test_a_missing_folder_world_fault_or_assignment_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"the folder .*/src does not exist: run this in the assignment's folder"):
        drive("a", "b", workspace=tmp_path)
    with pytest.raises(UsageError, match=r"there is no world 'moon'; there are: .*empty_room"):
        drive("a", "b", world="moon", workspace=tmp_path)
    with pytest.raises(UsageError, match=r"unknown fault 'fog': use nan, dead, or your own sim.Faults"):
        drive("a", "b", faults="fog", workspace=tmp_path)
    with pytest.raises(UsageError, match="'77_none' has no visible checks; choose one of: 00_welcome, "):
        check("77_none", tmp_path)


def test_a_grade_cell_outside_of_grading_is_worth_nothing_to_nbgrader() -> None:
    cell = new_code_cell('grade("02_nodes", "graph")', metadata={"nbgrader": {**GRADED, "points": 5}})
    cell.outputs = [new_output("execute_result", {"text/plain": repr(grade("02_nodes", "graph"))})]
    assert determine_grade(cell) == (0.0, 5)


LATER = ("It turns <left>.", "It stops.")


@pytest.mark.promise(
    "After `check(...)` has passed, it lists the hidden checks, which run only after you have submitted."
)
def test_a_report_lists_the_hidden_checks_if_all_visible_checks_passed() -> None:
    report = CheckReport("02_nodes", LINES[:1], later=LATER)
    assert repr(report).endswith(
        "After you submit, 2 more checks run with their own inputs:\n- It turns <left>.\n- It stops."
    )
    assert "<li>It turns &lt;left&gt;.</li><li>It stops.</li>" in report._repr_html_()


def test_a_report_lists_no_hidden_checks_if_a_visible_check_failed() -> None:
    report = CheckReport("02_nodes", LINES, later=LATER)
    assert "After you submit" not in repr(report) + report._repr_html_()
