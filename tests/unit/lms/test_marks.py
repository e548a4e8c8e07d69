"""Marks in the tables that Moodle and Canvas import: the mark cells are filled, and the other cells stay."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from autograder.cli import group
from autograder.exceptions import UsageError
from autograder.lms.marks import mark_table
from autograder.lms.roster import read_roster
from autograder.result.model import Result, Status, write_json
from tests.unit.lms.test_collect import CANVAS, MOODLE

MakeResult = Callable[..., Result]


@pytest.fixture
def table(tmp_path: Path) -> Callable[[str], Path]:
    def write(text: str) -> Path:
        (tmp_path / "table.csv").write_text(text, encoding="utf-8")
        return tmp_path / "table.csv"

    return write


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.promise(
    "Marks are scaled to the maximum in the table.",
    "The cell of a student without a grade or a submission stays empty.",
)
def test_moodle_gets_marks_scaled_to_its_own_maximum(
    tmp_path: Path, table: Callable[[str], Path], make_result: MakeResult
) -> None:
    stored = [
        make_result("zoe@example.edu"),
        make_result("jane@example.edu", status=Status.NOT_GRADED),
        make_result("eve@example.edu"),
    ]
    roster = read_roster(table(MOODLE))
    filled = mark_table(stored, "moodle", roster)
    filled.write(tmp_path / "out.csv")
    assert (filled.unknown, filled.marks) == (("eve@example.edu",), {"zoe@example.edu": ("", "40.00")})
    before, after = rows(tmp_path / "table.csv"), rows(tmp_path / "out.csv")
    assert [row.pop("Grade") for row in after] == ["40.00", "", ""]  # 4 of 10 points, of 100
    assert after == [{key: value for key, value in row.items() if key != "Grade"} for row in before]


@pytest.mark.promise(
    "`--format canvas`: the gradebook's name columns and the assignment's column",
    "marks go back to Moodle and Canvas in [their own formats]",
)
def test_canvas_gets_the_column_of_the_assignment_and_late_submissions_lose_points(
    tmp_path: Path, table: Callable[[str], Path], make_result: MakeResult
) -> None:
    stored = [make_result(name) for name in ("jdoe", "zoe")]
    roster = read_roster(table(CANVAS))
    mark_table(stored, "canvas", roster, {"jdoe": 0.75}).write(tmp_path / "out.csv")
    assert [(row["ID"], row["02 Nodes (55)"]) for row in rows(tmp_path / "out.csv")] == [
        ("", "10"),
        ("7001", "3.00"),
        ("7002", "4.00"),
        ("7999", ""),
    ]


def test_canvas_gets_a_new_column_if_no_column_is_that_of_the_assignment(
    tmp_path: Path, table: Callable[[str], Path], make_result: MakeResult
) -> None:
    roster = read_roster(table(CANVAS.replace("02 Nodes (55)", "Essay (9)")))
    mark_table([make_result("zoe")], "canvas", roster).write(tmp_path / "out.csv")
    assert list(rows(tmp_path / "out.csv")[0]) == [
        "Student",
        "ID",
        "SIS User ID",
        "SIS Login ID",
        "Section",
        "02_nodes",
    ]
    assert [row["02_nodes"] for row in rows(tmp_path / "out.csv")] == ["10.00", "", "4.00", ""]


@pytest.mark.parametrize(
    ("system", "text", "reason"),
    [
        ("moodle", "Identifier,Full name\nParticipant 1,Z\n", "the column 'grade' is missing"),
        ("moodle", MOODLE.replace("100.00", "many"), "'many' is not a number of points"),
        ("moodle", MOODLE.replace(",Yes,", ""), "row 2 has fewer columns than the headings"),
        ("canvas", CANVAS.replace("    Points Possible", "x"), "the row `Points Possible` is missing"),
    ],
)
def test_a_table_of_another_shape_is_a_usage_error(
    tmp_path: Path, table: Callable[[str], Path], make_result: MakeResult, system: str, text: str, reason: str
) -> None:
    roster = read_roster(table(text))
    stored = [make_result(student.id) for student in roster.students]
    with pytest.raises(UsageError, match=reason):
        mark_table(stored, system, roster)


@pytest.mark.promise("`--late-penalty 20` deducts a fifth of the marks of a late submission")
def test_export_applies_the_late_penalty_to_late_students(
    tmp_path: Path, table: Callable[[str], Path], make_result: MakeResult
) -> None:
    write_json(tmp_path / "results" / "zoe" / "result.json", make_result("zoe").to_json())
    write_json(tmp_path / "results" / "handed_in.json", {"late": ["zoe"]})
    command = ["export", str(tmp_path / "results"), "--format", "canvas", "--out", str(tmp_path / "out.csv")]
    assert isinstance(CliRunner().invoke(group, command).exception, UsageError)
    completed = CliRunner().invoke(group, [*command, "--roster", str(table(CANVAS)), "--late-penalty", "50"])
    assert completed.exit_code == 0, completed.output
    assert rows(tmp_path / "out.csv")[2]["02 Nodes (55)"] == "2.00"
