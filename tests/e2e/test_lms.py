"""From the zip that Moodle hands over to the worksheet that it takes back, by two commands."""

from __future__ import annotations

import csv
import io
import json
import subprocess
import sys
import zipfile
from pathlib import Path

from autograder.checks import suites
from autograder.proof.mutants import write_reference

ASSIGNMENT = "01_package_structure"
WORKSHEET = """Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed
Participant 101,Zoë Müller-Żak,zoe@example.edu,Submitted for grading,,50.00,Yes
Participant 102,Jane Doe,jane@example.edu,Submitted for grading,,50.00,Yes
Participant 103,Bob Roe,bob@example.edu,No submission,,50.00,Yes
"""


def test_a_class_goes_from_moodle_s_zip_to_moodle_s_worksheet(tmp_path: Path) -> None:
    write_reference(suites.hidden(ASSIGNMENT).sources, tmp_path / "tree")
    answer = io.BytesIO()
    with zipfile.ZipFile(answer, "w") as archive:
        for path in (path for path in (tmp_path / "tree").rglob("*") if path.is_file()):
            archive.write(path, f"my answer/ws/{path.relative_to(tmp_path / 'tree')}")
    with zipfile.ZipFile(tmp_path / "download.zip", "w") as archive:
        archive.writestr("Zoë Müller-Żak_101_assignsubmission_file_/Übung 1.zip", answer.getvalue())
        archive.writestr("Jane Doe_102_assignsubmission_file_/ws/src/notes.txt", "later")
        archive.writestr("Eve Stranger_999_assignsubmission_file_/answer.zip", b"")
    (tmp_path / "worksheet.csv").write_text(WORKSHEET, encoding="utf-8")

    def autograder(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "autograder", *arguments]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    graded = autograder("grade", "download.zip", "--assignment", ASSIGNMENT, "--roster", "worksheet.csv", "-j", "2")
    assert graded.returncode == 1, graded.stderr  # somebody is not in the roster
    assert "Not graded: Eve Stranger_999_assignsubmission_file_: no student of worksheet.csv fits." in graded.stderr
    assert "Nothing handed in: bob@example.edu" in graded.stdout
    assert json.loads((tmp_path / "results" / "handed_in.json").read_text())["missing"] == ["bob@example.edu"]
    exported = autograder("export", "results", "--format", "moodle", "--roster", "worksheet.csv", "--out", "marks.csv")
    assert exported.returncode == 0, exported.stderr
    with (tmp_path / "marks.csv").open(encoding="utf-8", newline="") as file:
        assert [row["Grade"] for row in csv.DictReader(file)] == ["50.00", "0.00", ""]
