"""Two gradings of a class, compared."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from autograder.cli import group
from autograder.report.export.changes import CheckChange, changes
from autograder.result.model import Result, write_json

MakeResult = Callable[..., Result]


def regraded(result: Result, points: float) -> Result:
    """Return the result with other points for its third check."""
    checks = list(result.checks)
    checks[2] = replace(checks[2], points=points)
    return replace(result, checks=tuple(checks))


def test_a_student_with_the_same_points_is_not_listed(make_result: MakeResult) -> None:
    assert changes([make_result("alice")], [make_result("alice")]) == ()


def test_a_corrected_check_is_listed_with_its_points(make_result: MakeResult) -> None:
    alice = make_result("alice")
    (change,) = changes([alice, make_result("bob")], [regraded(alice, 4.0), make_result("bob")])
    assert (change.student, change.before, change.after, change.same_submission) == ("alice", 4.0, 7.0, True)
    assert change.checks == (CheckChange("turns", 1.0, 4.0),)


def test_checks_whose_points_changed_are_listed_even_if_the_mark_is_the_same(make_result: MakeResult) -> None:
    alice = make_result("alice")
    swapped = replace(alice, checks=(replace(alice.checks[0], points=0.0), *regraded(alice, 2.0).checks[1:]))
    (change,) = changes([alice], [swapped])
    assert change.before == change.after
    assert [check.id for check in change.checks] == ["starts", "turns"]


def test_new_and_removed_checks_and_new_students_are_listed(make_result: MakeResult, ungraded_result: Result) -> None:
    alice = make_result("alice")
    without_one_check = replace(alice, checks=alice.checks[1:])
    listed_changes = changes([without_one_check], [alice, make_result("dora"), ungraded_result])
    assert listed_changes[0].checks == (CheckChange("starts", None, 1.0),)
    assert [(change.student, change.before, change.after) for change in listed_changes[1:]] == [("dora", None, 4.0)]


def test_a_student_with_two_results_is_refused(make_result: MakeResult) -> None:
    from autograder.exceptions import UsageError

    with pytest.raises(UsageError, match="the new results contain 'alice' twice for 02_nodes; use the folder of one"):
        changes([], [make_result("alice"), make_result("alice")])


@pytest.mark.promise("autograder compare results regraded")
def test_the_command_names_students_checks_and_another_submission(make_result: MakeResult, tmp_path: Path) -> None:
    alice = make_result("alice")
    write_json(tmp_path / "old" / "alice" / "result.json", alice.to_json())
    write_json(
        tmp_path / "new" / "alice" / "result.json", regraded(replace(alice, submission_sha256="0" * 64), 4.0).to_json()
    )
    arguments = ["compare", str(tmp_path / "old"), str(tmp_path / "new"), "--json", str(tmp_path / "found.json")]
    completed = CliRunner().invoke(group, arguments)
    assert completed.exit_code == 0
    assert completed.output.splitlines() == [
        "alice (02_nodes): 4 -> 7, for a different submission",
        "    turns: 1 -> 4",
        "1 student with a different result",
    ]
    (change,) = json.loads((tmp_path / "found.json").read_text())
    assert change["checks"] == [{"id": "turns", "before": 1.0, "after": 4.0}]
