"""The zips of feedback for upload to Moodle and Canvas, read as these systems read them.

`moodle_reads` and `canvas_reads` parse the names of files as the systems' own code does: Moodle's
mod/assign/feedback/file/importziplib.php (`is_valid_filename_for_import`), and Canvas's
app/models/abstract_assignment.rb (`infer_comment_context_from_filename`).
"""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath

import nbformat
import pytest
from click.testing import CliRunner
from click.testing import Result as Ran

from autograder.cli import group
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import UsageError
from autograder.result.model import Result, Status, write_json
from tests.unit.lms.test_collect import CANVAS, MOODLE

MakeResult = Callable[..., Result]


def moodle_reads(name: str, participants: set[int]) -> tuple[int, str, str] | None:
    """Return participant, plug-in and path of a file of the zip, None if Moodle ignores it."""
    if PurePosixPath(name).name.startswith((".", "~")):
        return None
    parts = f"/import/{name}".split("/")
    while parts:
        info = parts.pop(0).split("_", 4)
        if len(info) < 4 or not re.fullmatch(r"\d+", info[1]) or int(info[1]) not in participants:
            continue
        if (info[2], info[3]) != ("assignsubmission", "file"):
            continue
        return int(info[1]), info[3], "/".join([*info[4:], *parts])
    return None


def canvas_reads(path: str) -> tuple[str, str] | None:
    """Return user and attachment that Canvas finds in the name of a file, None if it ignores the file."""
    name = PurePosixPath(path).name
    parts = [part for part in name.split("_") if part != "LATE"]
    numbers = [part for part in parts if re.fullmatch(r"\d+", part)]
    if len(numbers) < 2 or parts[-1].startswith("link") or name.startswith("._"):
        return None
    return numbers[0], numbers[1]


def store_results(folder: Path, *results: Result) -> None:
    for result in results:
        write_json(folder / "results" / result.student / "result.json", result.to_json())


def export(folder: Path, form: str, roster: str, *options: str) -> Ran:
    (folder / "roster.csv").write_text(roster, encoding="utf-8-sig")
    command = ["export", str(folder / "results"), "--format", form, "--roster", str(folder / "roster.csv")]
    return CliRunner().invoke(group, [*command, "--out", str(folder / "feedback.zip"), *options])


@pytest.mark.promise(
    "autograder export results --format moodle-feedback --roster worksheet.csv --out feedback.zip",
    "`--format moodle-feedback`",
)
def test_moodle_gives_each_page_to_its_participant(tmp_path: Path, make_result: MakeResult) -> None:
    roster = MOODLE.replace("Jane  Doe", "Jane_999_assignsubmission_file_/../Doe")
    unclear = Diagnosis(Kind.UNCLEAR, "It holds two different answers.")
    store_results(
        tmp_path,
        make_result("zoe@example.edu"),
        make_result("jane@example.edu", status=Status.UNCLEAR, diagnosis=unclear, checks=()),
        make_result("bob@example.edu", status=Status.NOT_GRADED, checks=()),
        make_result("eve@example.edu"),
    )
    completed = export(tmp_path, "moodle-feedback", roster)
    assert completed.exit_code == 1
    assert "Left out: bob@example.edu: not graded" in completed.output
    assert "Left out: eve@example.edu: roster.csv has no identifier" in completed.output
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        assert archive.testzip() is None
        texts = {moodle_reads(name, {101, 102, 103}): archive.read(name).decode() for name in archive.namelist()}
    assert set(texts) == {(101, "file", "/feedback.html"), (102, "file", "/feedback.html")}
    assert "zoe@example.edu" in texts[101, "file", "/feedback.html"]
    assert "It holds two different answers." in texts[102, "file", "/feedback.html"]


@pytest.mark.skipif(shutil.which("unzip") is None, reason="needs unzip")
def test_another_programs_reader_unpacks_the_zip_with_names_of_any_language(
    tmp_path: Path, make_result: MakeResult
) -> None:
    store_results(tmp_path, make_result("zoe@example.edu"))
    assert export(tmp_path, "moodle-feedback", MOODLE).exit_code == 0
    command = ["unzip", "-q", str(tmp_path / "feedback.zip"), "-d", str(tmp_path / "unpacked")]
    subprocess.run(command, check=True, env={"LC_ALL": "C.UTF-8"})
    page = tmp_path / "unpacked" / "Zoë Müller-Żak_101_assignsubmission_file_" / "feedback.html"
    assert "zoe@example.edu" in page.read_text(encoding="utf-8")


def test_equal_results_make_equal_zips(tmp_path: Path, make_result: MakeResult) -> None:
    store_results(tmp_path, make_result("zoe@example.edu"))
    first, second = (
        (export(tmp_path, "moodle-feedback", MOODLE), (tmp_path / "feedback.zip").read_bytes())[1] for _ in range(2)
    )
    assert first == second


def canvas_download(folder: Path, *names: str) -> Path:
    path = folder / "submissions.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(name, "what was handed in")
    return path


def in_zip(data: bytes) -> bytes:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return archive.read("feedback.html")


def in_tar(data: bytes) -> bytes:
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        file = archive.extractfile("feedback.html")
        assert file is not None
        return file.read()


def in_notebook(data: bytes) -> bytes:
    (cell,) = nbformat.reads(data.decode(), as_version=4).cells
    return str(cell.source).encode()


@pytest.mark.promise(
    "autograder export results --format canvas-feedback --roster gradebook.csv --download submissions.zip",
    "`--format canvas-feedback`",
    "Canvas shows it under the name of the student's own file",
)
@pytest.mark.parametrize(
    ("name", "read_page"),
    [
        ("mllerzo_7002_9002_answer.zip", in_zip),
        ("mllerzo_LATE_7002_9002_02_nodes (1).ZIP", in_zip),
        *((f"mllerzo_7002_9002_answer{end}", in_tar) for end in (".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz")),
        ("mllerzo_7002_9002_page.html", bytes),
        ("mllerzo_7002_9002_02_nodes.ipynb", in_notebook),
    ],
)
def test_canvas_gives_each_student_a_file_of_the_kind_that_they_handed_in(
    tmp_path: Path, make_result: MakeResult, name: str, read_page: Callable[[bytes], bytes]
) -> None:
    store_results(tmp_path, make_result("zoe"))
    download = canvas_download(tmp_path, name, "doejane_7001_9001_answer.zip")
    completed = export(tmp_path, "canvas-feedback", CANVAS, "--download", str(download))
    assert completed.exit_code == 0, completed.output
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        assert archive.namelist() == [name]
        content = archive.read(name)
    assert canvas_reads(name) == ("7002", "9002")
    assert b"it kept driving: 0.08 m from the north wall" in read_page(content)


@pytest.mark.promise("A student who submitted nothing of this kind is listed, and the exit status is 1.")
def test_the_file_of_the_newest_attempt_that_opens_most_easily_is_used(tmp_path: Path, make_result: MakeResult) -> None:
    store_results(tmp_path, make_result("zoe"), make_result("jdoe"))
    download = canvas_download(
        tmp_path,
        "mllerzo_7002_9001_answer.zip",
        "mllerzo_LATE_7002_9002_answer-1.zip",
        "mllerzo_LATE_7002_9003_notes.ipynb",
        "doejane_7001_9004_report.pdf",
        "doejane_7001_9005_my_link.zip",  # Canvas takes it for a link
        "doejane_7001_text.html",
    )
    completed = export(tmp_path, "canvas-feedback", CANVAS, "--download", str(download))
    assert completed.exit_code == 1
    assert "Left out: jdoe: the download has no page, archive or notebook of this student" in completed.output
    with zipfile.ZipFile(tmp_path / "feedback.zip") as archive:
        assert archive.namelist() == ["mllerzo_LATE_7002_9002_answer-1.zip"]


def test_a_dry_run_lists_the_names_and_writes_no_zip(tmp_path: Path, make_result: MakeResult) -> None:
    store_results(tmp_path, make_result("zoe"))
    download = canvas_download(tmp_path, "mllerzo_7002_9002_answer.zip")
    completed = export(tmp_path, "canvas-feedback", CANVAS, "--download", str(download), "--dry-run")
    assert completed.exit_code == 0
    assert ["zoe", "mllerzo_7002_9002_answer.zip"] in [line.split() for line in completed.output.splitlines()]
    assert not (tmp_path / "feedback.zip").exists()


@pytest.mark.parametrize(
    ("form", "roster", "reason"),
    [
        ("canvas-feedback", CANVAS, "needs --download: the zip of the submissions"),
        ("moodle-feedback", CANVAS, "the column 'identifier' is missing; give the grading worksheet of Moodle"),
    ],
)
def test_missing_input_for_a_zip_of_feedback_is_named(
    tmp_path: Path, make_result: MakeResult, form: str, roster: str, reason: str
) -> None:
    store_results(tmp_path, make_result("zoe"))
    completed = export(tmp_path, form, roster)
    assert isinstance(completed.exception, UsageError)
    assert reason in str(completed.exception)
