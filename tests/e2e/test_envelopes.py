"""One correct answer is graded in several envelopes: each gets full marks, or is unclear and gets no mark."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.answers import BOOK, CHAPTER, TARGET, Answer, filled, make_answer, tarred, write, zipped


@pytest.fixture(scope="module")
def answer(tmp_path_factory: pytest.TempPathFactory) -> Answer:
    return make_answer(tmp_path_factory.mktemp("release"))


def grade(folder: Path, *options: str) -> tuple[subprocess.CompletedProcess[str], dict[str, dict[str, object]]]:
    """Grade the submissions in `folder`; return the finished process, and the results by student."""
    out = folder.parent / "results"
    command = [sys.executable, "-m", "autograder", "grade", str(folder), "--assignment", CHAPTER, "--out", str(out)]
    process = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
    return process, {path.parent.name: json.loads(path.read_text()) for path in out.glob("*/result.json")}


def marks(results: dict[str, dict[str, object]]) -> dict[str, object]:
    return {
        student: result["score"] if result["status"] == "graded" else result["status"]
        for student, result in results.items()
    }


@pytest.fixture(scope="module")
def a_class(answer: Answer, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("class") / "submissions"
    write(folder / "renamed", {**answer.released, "02_nodes (1).ipynb": answer.files[BOOK]})
    write(folder / "moodle", {"X.ZIP": zipped(answer.files), "readme.txt": b"see zip"})
    write(folder / "environment", {**answer.files, ".venv/x": b""})
    (folder / "environment" / ".venv" / "python").symlink_to("/usr/bin/python3")
    write(folder / "draft", {**answer.files, BOOK: filled(answer.released[BOOK], "draft = True\n")})
    write(folder / "two", {**answer.cells, "02_nodes (1).ipynb": filled(answer.released[BOOK], "other = True\n")})
    files = {
        "tar.tar.gz": tarred(answer.files, f"{CHAPTER}/", "w:gz"),
        "upper.ZIP": zipped(answer.files),
        "minor.ipynb": answer.notebook(lambda notebook: notebook.update(nbformat_minor=4)),
        "seven.7z": b"7z\xbc\xaf\x27\x1c",
        "notes.txt": b"",
    }
    write(folder, files)
    return folder


@pytest.mark.promise(
    "It then has no mark, the table says why, and the exit status is 1.",
    "It is listed with the reason and has no mark, and the exit status is 1.",
    "Two notebooks with different answers are unclear",
    '| The table says "unclear". |',
    "Renamed folders, nested archives, environments, caches and extra files do not change a mark.",
    "The grader uses the files that students checked: those in `ws/src`.",
    "Archives inside folders or other archives are opened",
    "The notebook itself runs only if its other cells have to create files.",
)
def test_each_envelope_gets_full_marks_or_is_unclear(a_class: Path) -> None:
    process, results = grade(a_class)
    full = results["draft"]["max_score"]
    clear = ("renamed", "moodle", "environment", "draft", "tar", "upper", "minor")
    assert marks(results) == {**dict.fromkeys(clear, full), "two": "unclear", "seven": "unclear"}
    assert process.returncode == 1
    assert "Unclear: two: The submission is unclear: it holds 2 notebooks with different answers" in process.stderr
    assert "Unclear: seven: seven.7z is a 7z archive, which the grader does not open: unpack it" in process.stderr
    assert "Not graded: notes.txt: it is not a folder, an archive or a notebook." in process.stderr
    assert "moodle: Not used: readme.txt." in process.stdout
    assert f"renamed: Not used: {BOOK}." in process.stdout
    notice = f"{TARGET} differs from the cell that writes it. The file counts"
    assert f"draft: {notice}" in process.stdout
    assert notice in (a_class.parent / "results" / "draft" / "feedback.html").read_text(encoding="utf-8")
    assert notice not in (a_class.parent / "results" / "tar" / "feedback.html").read_text(encoding="utf-8")
    assert "notebook" not in results["draft"]["phases"]  # type: ignore[operator]


@pytest.mark.promise("`--dry-run` grades nothing")
def test_a_dry_run_lists_the_graded_and_the_unused_files(a_class: Path) -> None:
    process = subprocess.run(
        [sys.executable, "-m", "autograder", "grade", str(a_class), "--assignment", CHAPTER, "--dry-run"],
        capture_output=True,
        text=True,
        check=False,
        cwd=a_class,
    )
    assert process.returncode == 1
    output = " ".join((process.stdout + process.stderr).split())
    for words in (
        "Not used: readme.txt.",
        "unclear seven.7z is a 7z archive",
        "Not graded: notes.txt",
        "files are graded",
    ):
        assert words in output
    assert not (a_class / "results").exists()


@pytest.mark.promise(
    "Only a student's newest attempt counts, with all of its files",
    "Every member of a Gradescope group gets the group's result.",
)
def test_all_files_of_a_canvas_attempt_and_all_members_of_a_gradescope_group_count(
    answer: Answer, tmp_path: Path
) -> None:
    canvas = {
        "smithbob_340934_208490284_work.zip": zipped(answer.files),
        "smithbob_340934_208490285_screenshot.png": b"\x89PNG",
    }
    write(tmp_path / "canvas" / "down", canvas)
    roster = tmp_path / "canvas" / "roster.csv"
    roster.write_text("Student,ID,SIS User ID,SIS Login ID,Section\nTwo,340934,S1,two,A\n")
    process, results = grade(tmp_path / "canvas" / "down", "--roster", str(roster))
    assert (process.returncode, marks(results)) == (0, {"two": results["two"]["max_score"]}), process.stderr
    assert "two: Not used: screenshot.png." in process.stdout

    write(tmp_path / "group" / "down" / "submission_1", answer.files)
    (tmp_path / "group" / "down" / "submission_metadata.yml").write_text(
        "---\nsubmission_1:\n  :submitters:\n  - :name: Pair One\n    :sid: '200'\n  - :name: Pair Two\n"
        "    :sid: '201'\n  :created_at: 2026-01-03 09:00:00 Z\n"
    )
    roster = tmp_path / "group" / "roster.csv"
    roster.write_text("Name,SID,Email\nPair One,200,one@example.edu\nPair Two,201,two@example.edu\n")
    process, results = grade(tmp_path / "group" / "down", "--roster", str(roster))
    assert process.returncode == 0, process.stderr
    assert marks(results) == dict.fromkeys(("200", "201"), results["200"]["max_score"])
    assert "Not submitted" not in process.stdout
