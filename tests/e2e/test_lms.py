"""Two commands turn Moodle's zip of submissions into the worksheet that Moodle imports."""

from __future__ import annotations

import csv
import io
import json
import re
import subprocess
import sys
import unicodedata
import zipfile
from functools import partial
from pathlib import Path

import pytest

from autograder.author.verification.mutants import mutants, write_mutant, write_reference
from autograder.report.export import load
from autograder.suite import suites

NAMES = ("Zoë Müller-Żak", "Jane Doe", "José  Ñandú", "王 小明", "Søren O'Neill, Jr.", "Ольга Ким")
HEADINGS = ("Identifier", "Full name", "Email address", "Status", "Grade", "Maximum Grade", "Grade can be changed")
TIMES = ("Last modified (submission)", "Last modified (grade)")
MAX_GRADE, PENALTY = 50.0, 10.0
SUBMITTED, LATE, NOTHING = "Submitted for grading - ", "Submitted for grading - 1 day 2 hours late", "No submission - "


def make_answers(assignment: str, flawed: int, folder: Path) -> list[list[tuple[str, bytes]]]:
    """Return answers, each as names and contents of files: the reference, flawed ones, and one without a package."""
    sources = suites.hidden(assignment).sources
    flawed_answers = [mutant for mutant in mutants(assignment) if not mutant.slow][:flawed]
    writers = [
        partial(write_reference, sources),
        *(partial(write_mutant, mutant, sources) for mutant in flawed_answers),
    ]
    answers = []
    for number, write in enumerate(writers):
        write(folder / str(number))
        files = sorted(path for path in (folder / str(number)).rglob("*") if path.is_file())
        answers.append([(str(path.relative_to(folder / str(number))), path.read_bytes()) for path in files])
    return [*answers, [("src/notes.txt", b"later")]]


def archive(folder: str, files: list[tuple[str, bytes]]) -> bytes:
    """Return a student's zip of a folder, which can have any name."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as zip_file:
        for name, content in files:
            zip_file.writestr(f"{folder}/ws/{name}", content)
    return data.getvalue()


def write_class(folder: Path, answers: list[list[tuple[str, bytes]]], students: int) -> dict[str, tuple[int, bool]]:
    """Write Moodle's zip and worksheet; return each submission's answer, by its number, and whether it was late."""
    submissions: dict[str, tuple[int, bool]] = {}
    rows: list[tuple[str, ...]] = [(*HEADINGS, *TIMES)]
    with zipfile.ZipFile(folder / "download.zip", "w") as download:
        for number in range(students):
            name = NAMES[number % len(NAMES)] + (f" {number}" if number >= len(NAMES) else "")
            identifier, is_late, is_empty = f"Participant {1000 + number}", number % 5 == 2, number % 6 == 4
            status = NOTHING if is_empty else LATE if is_late else SUBMITTED
            rows.append((identifier, name, f"s{number}@example.edu", status, "", f"{MAX_GRADE:.2f}", "Yes", "-", "-"))
            if is_empty:
                continue
            submissions[identifier] = number % len(answers), is_late
            prefix = f"{unicodedata.normalize('NFD', name)}_{1000 + number}_assignsubmission"
            submission = archive(f"my answer {number}", answers[number % len(answers)])
            download.writestr(f"{prefix}_file_/Übung 1 ({number}. Versuch).zip", submission)
        download.writestr(f"{NAMES[0]}_1000_assignsubmission_onlinetext_/onlinetext.html", "<p>Please!</p>")
        download.writestr("Eve Stranger_999_assignsubmission_file_/answer.zip", archive("answer", answers[0]))
    with (folder / "worksheet.csv").open("w", encoding="utf-8-sig", newline="") as file:
        csv.writer(file).writerows(rows)
    return submissions


def imported(path: Path, worksheet: Path) -> dict[str, str]:
    """Return the grades that Moodle imports from a worksheet (mod/assign/feedback/offline, lib/csvlib).

    Moodle rejects a table that lacks one of three headings, or whose rows have different lengths. It identifies
    students by the participant's number.
    """
    with path.open(encoding="utf-8", newline="") as file:
        headings, *rows = csv.reader(file, strict=True)
    assert {"Identifier", "Grade", "Last modified (grade)"} <= set(headings)
    assert {len(row) for row in rows} == {len(headings)}
    with worksheet.open(encoding="utf-8-sig", newline="") as file:
        exported = list(csv.reader(file, strict=True))
    grade = headings.index("Grade")
    other_columns = [[*row[:grade], *row[grade + 1 :]] for row in (headings, *rows)]
    assert other_columns == [[*row[:grade], *row[grade + 1 :]] for row in exported]
    assert all(re.fullmatch(r"Participant \d+", row[0]) for row in rows)
    return {row[0]: row[grade] for row in rows}


@pytest.mark.promise(
    "autograder grade download.zip --assignment 02_nodes --roster worksheet.csv --out results -j 4",
    "autograder export results --format moodle --roster worksheet.csv --out marks.csv",
    "A submission that matches no student is listed, and the exit status is 1.",
    "`results/handed_in.json` lists late students",
    "`--format moodle`: the worksheet with grades",
    "Downloads from Moodle, Canvas, Gradescope and GitHub Classroom are graded",
    "Marks are scaled to the maximum in the table.",
    "Two commands turn the system's download into a table of marks that it can import.",
)
@pytest.mark.parametrize(
    ("assignment", "flawed", "students"),
    [
        pytest.param("01_package_structure", 0, 6, id="6"),
        pytest.param("02_nodes", 8, 200, id="200", marks=[pytest.mark.nightly, pytest.mark.timeout(3600)]),
    ],
)
def test_moodles_zip_is_graded_and_its_worksheet_gets_the_marks(
    tmp_path: Path, assignment: str, flawed: int, students: int
) -> None:
    answers = make_answers(assignment, flawed, tmp_path / "answers")
    submissions = write_class(tmp_path, answers, students)

    def autograder(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "autograder", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    graded = autograder("grade", "download.zip", "--assignment", assignment, "--roster", "worksheet.csv", "-j", "2")
    assert graded.returncode == 1, graded.stderr  # a student is not in the roster
    assert (
        "Not graded: Eve Stranger_999_assignsubmission_file_: it matches no student in worksheet.csv." in graded.stderr
    )
    assert "onlinetext_: it is not a submitted file." in graded.stderr
    listed = json.loads((tmp_path / "results" / "handed_in.json").read_text())
    assert len(listed["missing"]) == students - len(submissions)
    assert len(listed["late"]) == sum(late for _, late in submissions.values())
    results = load(tmp_path / "results")
    assert len(results) == len(submissions)
    gradings = {(result.started, result.seconds, result.score) for result in results}
    assert len(gradings) <= len(answers)  # equal answers are graded once

    arguments = ("--format", "moodle", "--roster", "worksheet.csv", "--out", "marks.csv")
    exported = autograder("export", "results", *arguments, "--late-penalty", f"{PENALTY:g}")
    assert exported.returncode == 0, exported.stderr
    shares = {result.student: result.percent / 100 for result in results}
    marks = imported(tmp_path / "marks.csv", tmp_path / "worksheet.csv")
    assert len(marks) == students
    assert {identifier for identifier, mark in marks.items() if mark} == set(submissions)
    correct, no_package = 0, len(answers) - 1
    for identifier, (answer, late) in submissions.items():
        share = shares[f"s{int(identifier.removeprefix('Participant ')) - 1000}@example.edu"]
        assert (share == 1.0, share == 0.0) == (answer == correct, answer == no_package), identifier
        assert float(marks[identifier]) == pytest.approx(MAX_GRADE * share * (1 - PENALTY / 100 * late), abs=0.005)

    # 26 hours count as two late days, and as one day after an extension by a day.
    with_extension, *without_extension = (identifier for identifier, (_, late) in submissions.items() if late)
    (tmp_path / "extensions.csv").write_text(f"student,days\n{with_extension},1\n")
    daily = ("--late-per-day", f"{PENALTY:g}", "--extensions", "extensions.csv")
    assert autograder("export", "results", *arguments, *daily).returncode == 0
    extended = imported(tmp_path / "marks.csv", tmp_path / "worksheet.csv")
    assert extended[with_extension] == marks[with_extension]
    for identifier in without_extension:
        unpenalized = float(marks[identifier]) / (1 - PENALTY / 100)
        assert float(extended[identifier]) == pytest.approx(unpenalized * (1 - 2 * PENALTY / 100), abs=0.02)
