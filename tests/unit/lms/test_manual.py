"""Points that a person gave are part of marks and feedback, and a wrong table is an error that names the line."""

from __future__ import annotations

import csv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner
from click.testing import Result as Ran

from autograder.cli import group
from autograder.exceptions import UsageError
from autograder.lms.manual import manual_cells
from autograder.result.model import CheckResult, Result, Status, write_json
from autograder.suite import Check, Outcome

MakeResult = Callable[..., Result]
MakeCheck = Callable[..., Check]
WORKSHEET = """Identifier,Full name,Email address,Status,Grade,Maximum Grade,Last modified (grade)
Participant 101,Zoë Müller,zoe@x.edu,Submitted,,52.00,
Participant 102,Jane Doe,jane@x.edu,Submitted,,52.00,
Participant 103,Bob Roe,bob@x.edu,No submission,,52.00,
"""
GRADEBOOK = """Student,ID,SIS Login ID,Section,09 Assessment (77)
    Points Possible,,,,52
"Müller, Zoë",7001,zoe@x.edu,A,
"Doe, Jane",7002,jane@x.edu,A,
"""


@pytest.fixture
def results_folder(tmp_path: Path, make_result: MakeResult, make_check: MakeCheck) -> Path:
    """Write results of 09 in which each student has all 46 points that programs give."""
    for student in ("zoe@x.edu", "jane@x.edu"):
        check = CheckResult.of(make_check("all", "Everything works.", 46, "nodes"), Outcome.PASSED)
        result = make_result(student, assignment="09_assessment", checks=(check,), max_score=46.0)
        write_json(tmp_path / "results" / student / "result.json", result.to_json())
    (tmp_path / "worksheet.csv").write_text(WORKSHEET, encoding="utf-8")
    (tmp_path / "gradebook.csv").write_text(GRADEBOOK, encoding="utf-8")
    return tmp_path


def export(folder: Path, form: str, *options: str) -> Ran:
    command = ["export", str(folder / "results"), "--format", form, "--out", str(folder / "out.csv")]
    return CliRunner().invoke(group, [*command, *options])


def with_points(folder: Path, text: str, form: str = "moodle", roster: str = "worksheet.csv") -> Ran:
    (folder / "manual.csv").write_text(text, encoding="utf-8")
    return export(folder, form, "--roster", str(folder / roster), "--manual", str(folder / "manual.csv"))


def column(path: Path, name: str) -> list[str]:
    with path.open(encoding="utf-8", newline="") as file:
        return [row[name] for row in csv.DictReader(file)]


def test_the_cells_that_a_person_grades_are_those_of_the_courses_notebook() -> None:
    assert manual_cells("09_assessment") == {"q2-answer": 6.0}
    assert manual_cells("02_nodes") == {}


@pytest.mark.promise(
    "autograder export results --format moodle --roster worksheet.csv --manual manual.csv --out marks.csv",
    "`--manual` adds the points that a person gave",
)
@pytest.mark.parametrize(
    ("form", "roster", "name", "marks"),
    [
        ("moodle", "worksheet.csv", "Grade", ["52.00", "50.50", ""]),
        ("canvas", "gradebook.csv", "09 Assessment (77)", ["52", "52.00", "50.50"]),
    ],
)
def test_the_points_of_a_person_are_added_so_that_all_of_52_can_be_reached(
    results_folder: Path, form: str, roster: str, name: str, marks: list[str]
) -> None:
    completed = with_points(results_folder, "student,q2-answer\nzoe@x.edu,6\njane@x.edu,4.5\n", form, roster)
    assert completed.exit_code == 0, completed.output
    assert column(results_folder / "out.csv", name) == marks


@pytest.mark.promise("with `--roster`, by anything in the roster")
def test_students_are_named_by_anything_in_the_roster(results_folder: Path) -> None:
    completed = with_points(results_folder, "student,q2-answer\nZoë  müller,6\nParticipant 102,0\nBob Roe,\n")
    assert completed.exit_code == 0, completed.output
    assert column(results_folder / "out.csv", "Grade") == ["52.00", "46.00", ""]


@pytest.mark.promise("A student who has not been marked yet has no mark, is listed, and the exit status is 1.")
def test_a_student_who_has_not_been_marked_yet_gets_no_mark_and_is_listed(results_folder: Path) -> None:
    for text in ("student,q2-answer\nzoe@x.edu,6\n", "student,q2-answer\nzoe@x.edu,6\njane@x.edu,\n"):
        completed = with_points(results_folder, text)
        assert completed.exit_code == 1
        assert "Left out: jane@x.edu: Not marked yet: q2-answer." in completed.output
        assert column(results_folder / "out.csv", "Grade") == ["52.00", "", ""]


def test_points_and_the_comment_of_a_person_are_on_the_feedback_page_and_in_the_csv(results_folder: Path) -> None:
    (results_folder / "manual.csv").write_text(
        "student,q2-answer,q2-answer comment\nzoe@x.edu,4,<Where> is the QoS?\njane@x.edu,6,\n"
    )
    manual = ("--manual", str(results_folder / "manual.csv"))
    assert export(results_folder, "csv", *manual).exit_code == 0
    assert column(results_folder / "out.csv", "check q2-answer") == ["6.0", "4.0"]
    assert column(results_folder / "out.csv", "max_score") == ["52.0", "52.0"]
    pages = [
        "export",
        str(results_folder / "results"),
        "--format",
        "html",
        "--out",
        str(results_folder / "pages"),
        *manual,
    ]
    assert CliRunner().invoke(group, pages).exit_code == 0
    page = (results_folder / "pages" / "zoe@x.edu" / "feedback.html").read_text(encoding="utf-8")
    assert "&lt;Where&gt; is the QoS?" in page
    assert "of 52 points" in page


@pytest.mark.promise("`--manual` works here, too: students who have not been marked yet are left out.")
def test_the_zip_of_feedback_has_the_points_of_a_person_and_leaves_out_students_without_them(
    results_folder: Path,
) -> None:
    completed = with_points(results_folder, "student,q2-answer\nzoe@x.edu,6\n", "moodle-feedback")
    assert completed.exit_code == 1
    assert "Left out: jane@x.edu: Not marked yet: q2-answer." in completed.output
    with zipfile.ZipFile(results_folder / "out.csv") as archive:
        assert archive.namelist() == ["Zoë Müller_101_assignsubmission_file_/feedback.html"]
        assert "of 52 points" in archive.read(archive.namelist()[0]).decode()


def test_without_the_option_the_missing_points_are_named(results_folder: Path) -> None:
    completed = export(results_folder, "csv")
    assert completed.exit_code == 0
    assert "09_assessment has 6 manual points (q2-answer), which are missing here" in completed.output


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("student,points\nzoe@x.edu,6\n", "manual.csv, line 1: the column 'q2-answer' is missing"),
        ("student;q2-answer\nzoe@x.edu;6\n", "manual.csv, line 1: the column 'student' is missing; commas separate"),
        ("student,q2-answer,Q2-Answer\nzoe@x.edu,6,6\n", "manual.csv, line 1: the column 'q2-answer' occurs twice"),
        ("student,q2-answer\nzoe@x.edu,6\n\neve,1\n", "manual.csv, line 4: 'eve' matches no student or several"),
        (
            "student,q2-answer\nzoe@x.edu,6.5\n",
            "manual.csv, line 2: 6.5 points for q2-answer: the points must",
        ),
        ("student,q2-answer\nzoe@x.edu,-1\n", "manual.csv, line 2: -1 points"),
        ("student,q2-answer\nzoe@x.edu,nan\n", "manual.csv, line 2: nan points"),
        ('student,q2-answer\nzoe@x.edu,"4,5"\n', "manual.csv, line 2: '4,5' is not a number of points"),
        ("student,q2-answer\nzoe@x.edu,6\njane@x.edu\n", "manual.csv, line 3: 1 cells, but 2 headings"),
        ("student,q2-answer\nzoe@x.edu,6\nZoë Müller,6\n", "line 3: zoe@x.edu is also in .*, line 2: remove"),
        ("student,q2-answer\nbob@x.edu,2\n", "points for bob@x.edu without a result"),
        ("", "the table is empty; its columns are student, q2-answer"),
        ('student,q2-answer\n"zoe', "manual.csv: cannot be read as CSV"),
    ],
)
def test_a_wrong_table_of_points_is_an_error_that_names_the_line_and_writes_nothing(
    results_folder: Path, text: str, reason: str
) -> None:
    completed = with_points(results_folder, text)
    assert isinstance(completed.exception, UsageError)
    with pytest.raises(UsageError, match=reason):
        raise completed.exception
    assert not (results_folder / "out.csv").exists()


def test_an_assignment_without_manual_cells_accepts_no_table_of_points(tmp_path: Path, make_result: MakeResult) -> None:
    write_json(tmp_path / "results" / "zoe" / "result.json", make_result("zoe").to_json())
    (tmp_path / "manual.csv").write_text("student,q2-answer\nzoe,6\n")
    completed = export(tmp_path, "csv", "--manual", str(tmp_path / "manual.csv"))
    assert "02_nodes has no manually graded cells" in str(completed.exception)


@pytest.mark.promise("`--dry-run` writes nothing and lists")
def test_a_dry_run_lists_the_marks_and_writes_nothing(results_folder: Path, make_result: MakeResult) -> None:
    write_json(
        results_folder / "results" / "eve" / "result.json", make_result("eve", assignment="09_assessment").to_json()
    )
    text = WORKSHEET.replace("jane@x.edu,Submitted,,", "jane@x.edu,Submitted,12.00,")
    (results_folder / "worksheet.csv").write_text(text, encoding="utf-8")
    (results_folder / "manual.csv").write_text("student,q2-answer\nzoe@x.edu,6\njane@x.edu,3\neve,1\n")
    before = sorted(results_folder.rglob("*"))
    options = (
        "--roster",
        str(results_folder / "worksheet.csv"),
        "--manual",
        str(results_folder / "manual.csv"),
        "--dry-run",
    )
    completed = export(results_folder, "moodle", *options)
    assert completed.exit_code == 1
    rows = [line.split() for line in completed.output.splitlines()]
    assert ["zoe@x.edu", "52.00"] in rows
    assert ["jane@x.edu", "12.00", "49.00"] in rows
    assert "Nothing was written." in completed.output
    assert sorted(results_folder.rglob("*")) == before
    for form in ("csv", "html", "gradescope", "junit", "markdown"):
        completed = export(results_folder, form, *options)
        assert (completed.exit_code, sorted(results_folder.rglob("*"))) == (0, before), form
        assert ["zoe@x.edu", "52"] in [line.split() for line in completed.output.splitlines()]


def test_points_of_a_person_give_no_mark_to_an_ungraded_result(results_folder: Path, make_result: MakeResult) -> None:
    broken = make_result("jane@x.edu", assignment="09_assessment", status=Status.NOT_GRADED, checks=())
    write_json(results_folder / "results" / "jane@x.edu" / "result.json", broken.to_json())
    completed = with_points(results_folder, "student,q2-answer\nzoe@x.edu,6\njane@x.edu,6\n")
    assert completed.exit_code == 1
    assert "Left out: jane@x.edu: not graded" in completed.output
    assert column(results_folder / "out.csv", "Grade") == ["52.00", "", ""]
