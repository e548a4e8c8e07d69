"""The formats that results are exported to, read back with each format's own reader."""

from __future__ import annotations

import csv
import json
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from nbconvert.filters.markdown import markdown2html

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.report.export import FORMATS, formats, write
from autograder.report.feedback.text import NOT_GRADED
from autograder.result.model import Artifact, CheckResult, Result
from autograder.ros.distribution import DISTRIBUTION
from autograder.suite import Check, Outcome

MakeResult = Callable[..., Result]
Class = list[Result]


@pytest.fixture
def a_class(make_result: MakeResult, broken_result: Result, ungraded_result: Result, tmp_path: Path) -> Class:
    return [replace(result, folder=tmp_path) for result in (make_result(), broken_result, ungraded_result)]


@pytest.fixture
def hostile_class(make_result: MakeResult, make_check: Callable[..., Check], tmp_path: Path) -> Class:
    text = "=1+1|<script>`x`[a](b)\x00\udcff\n# head"
    check = CheckResult.of(make_check("c", text, 1, "g"), Outcome.FAILED, text)
    diagnosis = Diagnosis(Kind.CRASHED_LATER, text, text)
    return [make_result("=cmd", checks=(check,), diagnosis=diagnosis)]


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.promise(
    "autograder export results --format csv --out marks.csv", "| `classroom_roster.csv` | `--format csv` |"
)
def test_csv_has_a_row_for_each_submission_and_a_column_for_each_check(a_class: Class, tmp_path: Path) -> None:
    alice, bob, carol = rows(write(a_class, "csv", tmp_path / "new" / "marks.csv"))
    assert (alice["student"], alice["score"], alice["max_score"], alice["percent"]) == ("alice", "4.0", "10.0", "40.0")
    assert (alice["check turns"], alice["check starts"]) == ("1.0", "1.0")
    assert (bob["diagnosis"], bob["check listens"]) == ("build_failed", "")
    assert (carol["status"], carol["score"], carol["percent"]) == ("not_graded", "", "")


def test_csv_contains_no_formula(hostile_class: Class, tmp_path: Path) -> None:
    (row,) = rows(write(hostile_class, "csv", tmp_path / "marks.csv"))
    assert row["student"] == "'=cmd"
    assert row["reason"] == "'=1+1|<script>`x`[a](b)\ufffd\ufffd # head"


@pytest.mark.parametrize("delimiter", [",", ";", "\t", "|"])
@pytest.mark.parametrize("template", ["{}=1", '{}"=1', '"{}"=1"{}', "{} '=1{}", '{}""" @x', "a{}b{}-1{}"])
def test_csv_contains_no_formula_whichever_separator_a_spreadsheet_assumes(
    make_result: Callable[..., Result], tmp_path: Path, template: str, delimiter: str
) -> None:
    text = template.replace("{}", delimiter)
    sentence = Diagnosis(Kind.BUILD_FAILED, f"see {text}")
    path = write([make_result("ada", diagnosis=sentence)], "csv", tmp_path / "marks.csv")
    with path.open(encoding="utf-8", newline="") as file:
        cells = [cell for row in csv.reader(file, delimiter=delimiter) for cell in row]
    assert any("1" in cell or "x" in cell for cell in cells)
    assert not [cell for cell in cells if cell.lstrip(" \"'")[:1] in tuple("=+-@") and cell.lstrip(' "')[:1] != "'"]


def test_junit_counts_and_names_each_outcome(a_class: Class, tmp_path: Path) -> None:
    root = ET.parse(write(a_class, "junit", tmp_path / "junit.xml")).getroot()
    assert dict(root.attrib) == {"tests": "8", "failures": "2", "errors": "1", "skipped": "3"}
    alice, _, carol = root.findall("testsuite")
    assert alice.get("name") == "02_nodes: alice"
    failure = alice.find("testcase[@name='turns']/failure")
    assert failure is not None
    assert failure.get("message") == "it kept driving: 0.08 m from the north wall"
    assert failure.text is not None
    assert failure.text.endswith("1 of 4 points")
    assert alice.find("testcase[@name='stops']/skipped") is not None
    assert alice.find("testcase[@name='starts']/*") is None
    error = carol.find("testcase/error")
    assert error is not None
    assert NOT_GRADED in error.get("message", "")


def test_junit_is_well_formed_for_any_text_of_a_student(hostile_class: Class, tmp_path: Path) -> None:
    root = ET.parse(write(hostile_class, "junit", tmp_path / "junit.xml")).getroot()
    failure = root.find("testsuite/testcase/failure")
    assert failure is not None
    assert failure.get("message") == "=1+1|<script>`x`[a](b)\ufffd\ufffd # head"


def gradescope(stored: Class, out: Path) -> list[dict[str, Any]]:
    assert write(stored, "gradescope", out) == out
    return [json.loads((out / item.student / "results.json").read_text(encoding="utf-8")) for item in stored]


@pytest.mark.promise("`--format gradescope`: a `results.json` for each submission")
def test_gradescope_gets_the_score_and_a_test_for_each_check(a_class: Class, tmp_path: Path) -> None:
    alice, bob, _ = gradescope(a_class, tmp_path / "out")
    assert (alice["score"], alice["execution_time"], alice["output"]) == (4.0, 12, "")
    assert sum(test["score"] for test in alice["tests"]) == alice["score"]
    turns = alice["tests"][2]
    assert (turns["status"], turns["score"], turns["max_score"]) == ("failed", 1.0, 4)
    assert turns["output"].splitlines() == [
        "it kept driving: 0.08 m from the north wall",
        "Hint: Where is 0 rad in a scan?",
        "Hint: Compare the smallest forward range with 1.0.",
        f"{DISTRIBUTION.docs}/p/sensor_msgs/",
    ]
    assert alice["tests"][3]["tags"] == ["safety", "not_checked"]
    assert bob["output"] == "The package does not build: setup.py line 3."


def test_gradescope_names_the_cause_of_a_consequence(a_class: Class, tmp_path: Path) -> None:
    tests = json.loads((write(a_class, "gradescope", tmp_path / "g") / "alice" / "results.json").read_text())["tests"]
    advice = f'Probably caused by "{tests[2]["name"]}": fix that first and run again.'
    assert tests[3]["output"] == f"Not checked. {advice}"
    assert advice not in tests[2]["output"] + tests[4]["output"]


@pytest.mark.promise("Students see the results of hidden checks when you publish the marks.")
def test_gradescope_shows_hidden_checks_with_the_marks(a_class: Class, tmp_path: Path) -> None:
    tests = gradescope(a_class, tmp_path / "out")[0]["tests"]
    assert {test["visibility"] for test in tests} == {"after_published"}


def test_gradescope_gets_no_zero_for_an_ungraded_submission(a_class: Class, tmp_path: Path) -> None:
    carol = gradescope(a_class, tmp_path / "out")[2]
    assert set(carol) == {"output"}
    assert NOT_GRADED in carol["output"]


@pytest.mark.promise("autograder export results --format html --out pages")
def test_html_has_a_page_for_each_student_with_its_pictures_and_a_table(
    make_result: MakeResult, track: Callable[..., Artifact], tmp_path: Path
) -> None:
    stored = [make_result(artifacts=(track(tmp_path / "in"),), folder=tmp_path / "in")]
    index = write(stored, "html", tmp_path / "out")
    assert index == tmp_path / "out" / "index.html"
    assert 'href="alice/feedback.html"' in index.read_text(encoding="utf-8")
    assert "data:image/png;base64," in (tmp_path / "out" / "alice" / "feedback.html").read_text(encoding="utf-8")


def test_markdown_has_a_table_and_a_section_for_each_student(a_class: Class, tmp_path: Path) -> None:
    text = write(a_class, "markdown", tmp_path / "report.md").read_text(encoding="utf-8")
    for line in (
        "| alice | 02\\_nodes | 4 / 10 |  |",
        "| bob | 02\\_nodes | 0 / 10 | The package does not build: setup.py line 3. |",
        "## carol: not graded",
        "| ✗ | The robot turns when something stands within 1 m in front of it. | 1 / 4 "
        "| it kept driving: 0.08 m from the north wall |",
    ):
        assert line in text.splitlines()


def test_markdown_shows_a_students_text_as_text(hostile_class: Class, tmp_path: Path) -> None:
    html = markdown2html(write(hostile_class, "markdown", tmp_path / "report.md").read_text(encoding="utf-8"))
    assert "<script>" not in html
    assert '<a href="b"' not in html
    assert html.count("<tr>") == 4  # two tables of a head and a row: no line of the student's broke one
    assert "&lt;script&gt;`x`[a](b)" in html


def test_each_module_of_the_folder_is_a_format() -> None:
    assert {"csv", "gradescope", "html", "junit", "markdown"} <= set(FORMATS)
    folder = Path(formats.__file__).parent
    assert sorted(FORMATS) == sorted(path.stem for path in folder.glob("*.py") if path.stem != "__init__")


@pytest.mark.parametrize("format", FORMATS)
def test_a_format_that_needs_a_folder_refuses_a_file_and_the_reverse(format: str, tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    wrong, kind = (file, "folder") if FORMATS[format].FOLDER else (tmp_path, "file")
    with pytest.raises(UsageError, match=f"{format} is written to a {kind}; give the path of a {kind}"):
        write([], format, wrong)


@pytest.mark.parametrize("format", [name for name, format in FORMATS.items() if format.FOLDER])
def test_two_results_of_one_student_do_not_overwrite_each_other(
    format: str, make_result: MakeResult, tmp_path: Path
) -> None:
    twice = [make_result()] * 2
    with pytest.raises(UsageError, match="the student 'alice' has two results; export one assignment at a time"):
        write(twice, format, tmp_path / "out")


@pytest.mark.parametrize("student", ["..", "a/b", "", "."])
def test_a_student_whose_name_is_a_path_gets_no_folder(student: str, make_result: MakeResult, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be the name of a folder"):
        write([make_result(student)], "html", tmp_path / "out")
