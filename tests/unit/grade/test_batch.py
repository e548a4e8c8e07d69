"""Finding a class's submissions, and keeping results that are still valid."""

from __future__ import annotations

import json
import threading
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import Any

import pytest

from autograder.exceptions import UsageError
from autograder.grade import batch
from autograder.grade.batch import discover, grade_all
from autograder.grade.job import Job
from autograder.grade.store import write_result
from autograder.result.model import Result, Status
from autograder.submission import intake

CHAPTER = "02_nodes"
MakeResult = Callable[..., Result]


def _submission(folder: Path) -> Path:
    (folder / "src" / "pkg").mkdir(parents=True)
    (folder / "src" / "pkg" / "package.xml").write_text("<package/>")
    return folder


def _discovered(*paths: Path) -> list[tuple[str, str]]:
    return [(student, path.name) for student, path in discover(paths, CHAPTER).submissions.items()]


def test_a_single_submission_has_the_name_of_its_folder_or_file(tmp_path: Path) -> None:
    (tmp_path / "bob.zip").write_bytes(b"")
    assert _discovered(_submission(tmp_path / "alice"), tmp_path / "bob.zip") == [
        ("alice", "alice"),
        ("bob", "bob.zip"),
    ]


@pytest.mark.promise(
    "This command grades a folder with one submission for each student:",
    "Without `--roster`, the student's name is the clone's whole name.",
)
def test_a_folder_of_submissions_has_one_submission_for_each_student(tmp_path: Path) -> None:
    _submission(tmp_path / "class" / "bob")
    (tmp_path / "class" / "alice.zip").write_bytes(b"")
    (tmp_path / "class" / "carol.ipynb").write_bytes(b"{}")
    (tmp_path / "class" / "notes.txt").write_bytes(b"")
    (tmp_path / "class" / ".hidden").mkdir()
    discovered = discover((tmp_path / "class",), CHAPTER)
    assert list(discovered.submissions) == ["alice", "bob", "carol"]
    assert [name for name, _ in discovered.other_files] == ["notes.txt"]


def test_an_archive_with_any_file_ending_is_a_submission(tmp_path: Path) -> None:
    names = ["ada.tar.gz", "bob.ZIP", "cyd.7z", "dan.Ipynb", "eve.tgz", "fay.rar", "gus.ipynb.txt"]
    for name in names:
        (tmp_path / name).write_bytes(b"")
    assert _discovered(tmp_path) == [(name.partition(".")[0], name) for name in names]


def test_files_beside_a_students_folder_of_the_assignment_belong_to_the_submission(tmp_path: Path) -> None:
    for student in ("alice", "bob"):
        _submission(tmp_path / "submitted" / student / CHAPTER)
    (tmp_path / "submitted" / "alice" / "timestamp.txt").write_text("")
    (tmp_path / "submitted" / "bob" / "better.zip").write_bytes(b"")
    assert _discovered(tmp_path / "submitted") == [("alice", CHAPTER), ("bob", "bob")]


def test_nbgrader_s_submitted_layout_is_understood(tmp_path: Path) -> None:
    for student in ("alice", "bob"):
        _submission(tmp_path / "submitted" / student / CHAPTER)
    assert _discovered(tmp_path / "submitted") == [("alice", CHAPTER), ("bob", CHAPTER)]


def test_an_empty_submission_in_a_class_is_still_a_submission(tmp_path: Path) -> None:
    (tmp_path / "class" / "dave").mkdir(parents=True)
    assert _discovered(tmp_path / "class") == [("dave", "dave")]


def test_an_empty_folder_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="neither a submission of 02_nodes nor a folder of submissions"):
        discover((tmp_path,), CHAPTER)


def test_a_missing_path_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="nobody: there is no such file or folder"):
        discover((tmp_path / "nobody",), CHAPTER)


@pytest.mark.parametrize("name", ["index.html", "earlier-marks.json", "handed_in.json", "results.json", "result.json"])
def test_a_submission_with_the_name_of_a_file_beside_the_results_is_not_graded(tmp_path: Path, name: str) -> None:
    for student in ("ada", name):
        _submission(tmp_path / student)
    discovered = discover((tmp_path,), CHAPTER)
    assert discovered.submissions == {"ada": tmp_path / "ada"}
    assert discovered.other_files == ((name, f"{name} is the name of a file beside the results: give it another name"),)


def test_two_submissions_with_the_same_name_are_a_usage_error(tmp_path: Path) -> None:
    _submission(tmp_path / "a" / "alice")
    (tmp_path / "alice.zip").write_bytes(b"")
    with pytest.raises(UsageError, match="two submissions are called alice: rename one"):
        discover((tmp_path / "a" / "alice", tmp_path / "alice.zip"), CHAPTER)


class Grader:
    """Replaces grade_submission: records the students, and waits until `together` submissions are graded at once."""

    def __init__(self, make_result: MakeResult, together: int) -> None:
        self.graded: list[str] = []
        self._make = make_result
        self._meeting = threading.Barrier(together)

    def __call__(self, job: Job) -> Result:
        self._meeting.wait(60)
        self.graded.append(job.student)
        result = self._make(
            job.student,
            seed=job.seed,
            submission_sha256=intake.read_submission(job.path, job.assignment).sha256,
            suite_version=job.suite.version,
        )
        return write_result(job, result, {})


@pytest.fixture
def submissions(tmp_path: Path) -> dict[str, Path]:
    """The class: two submissions with different answers."""
    (_submission(tmp_path / "alice") / "src" / "pkg" / "README").write_text("alice's")
    return {"alice": tmp_path / "alice", "bob": _submission(tmp_path / "bob")}


@pytest.fixture
def grade(
    tmp_path: Path, submissions: dict[str, Path], make_result: MakeResult, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., list[str]]:
    """Grade the class; return the students who were actually graded."""

    def run(*, together: int = 1, **options: Any) -> list[str]:
        grader = Grader(make_result, together)
        monkeypatch.setattr(batch, "grade_submission", grader)
        results = grade_all(submissions, CHAPTER, **{"seed": 7, "out": tmp_path / "out", "jobs": 2, **options})
        assert [result.student for result in results] == ["alice", "bob"]
        return sorted(grader.graded)

    return run


@pytest.mark.promise("Identical submissions are graded once, and the result is stored for each of them.")
def test_equal_submissions_are_graded_once_and_get_the_same_result(
    grade: Callable[..., list[str]], tmp_path: Path
) -> None:
    (tmp_path / "bob" / "src" / "pkg" / "README").write_text("alice's")
    (tmp_path / "bob" / "log").mkdir()  # not part of a submission
    assert grade() == ["alice"]
    alice, bob = (json.loads((tmp_path / "out" / name / "result.json").read_text()) for name in ("alice", "bob"))
    assert (alice.pop("student"), bob.pop("student")) == ("alice", "bob")
    assert alice == bob
    assert grade(resume=True) == []
    (tmp_path / "bob" / "src" / "pkg" / "README").chmod(0o755)  # a script that can be run is another answer
    assert grade(resume=True) == ["bob"]


@pytest.mark.promise("Packaging, such as the name of the zip, makes no difference.")
def test_equal_submissions_are_equal_in_any_archive_or_folder(tmp_path: Path) -> None:
    folder = _submission(tmp_path / "alice")
    with zipfile.ZipFile(tmp_path / "bob.zip", "w") as archive:
        archive.write(folder / "src" / "pkg" / "package.xml", "my answer/src/pkg/package.xml")
    alice, bob = (intake.read_submission(path, CHAPTER) for path in (folder, tmp_path / "bob.zip"))
    assert alice.graded_sha256 == bob.graded_sha256
    assert alice.sha256 != bob.sha256


def test_a_notebook_that_runs_differs_from_packages_with_the_same_files() -> None:
    """Otherwise, whoever is graded first would also decide the other student's mark."""
    notebook = intake.SubmittedFile(PurePosixPath(f"{CHAPTER}.ipynb"), b"{}")
    other = intake.SubmittedFile(PurePosixPath("pkg/package.xml"), b"<package/>")
    packages = intake._graded_digest(None, (notebook, other), (), (notebook, other), CHAPTER)
    runs = intake._graded_digest(notebook.data, (), (other,), None, CHAPTER)
    assert packages != runs


def test_as_many_submissions_are_graded_at_once_as_requested(grade: Callable[..., list[str]]) -> None:
    assert grade(together=2, jobs=2) == ["alice", "bob"]


@pytest.mark.promise("same command with `--resume` grades the remaining submissions and those that have changed since")
def test_a_resumed_run_grades_only_what_has_changed(grade: Callable[..., list[str]], tmp_path: Path) -> None:
    grade()
    assert grade(resume=True) == []
    assert grade(resume=False) == ["alice", "bob"]
    assert grade(resume=True, seed=8) == ["alice", "bob"]
    (tmp_path / "bob" / "src" / "pkg" / "setup.py").write_text("")
    assert grade(resume=True, seed=8) == ["bob"]


@pytest.mark.parametrize("stored", ["", "{}", "[1]", '{"schema": "other"}'])
def test_a_submission_with_an_invalid_stored_result_is_graded_again(
    grade: Callable[..., list[str]], tmp_path: Path, stored: str
) -> None:
    grade()
    (tmp_path / "out" / "alice" / "result.json").write_text(stored)
    assert grade(resume=True) == ["alice"]


@pytest.mark.promise(
    "Run the same command with `--resume`.", "Grading continues with the rest; `--resume` tries it again."
)
def test_a_submission_that_was_not_graded_is_graded_again(grade: Callable[..., list[str]], tmp_path: Path) -> None:
    grade()
    path = tmp_path / "out" / "alice" / "result.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), "status": Status.NOT_GRADED.value}))
    assert grade(resume=True) == ["alice"]


def test_each_result_is_announced(grade: Callable[..., list[str]]) -> None:
    announced_students: list[str] = []
    grade(on_result=lambda result: announced_students.append(result.student))
    assert sorted(announced_students) == ["alice", "bob"]
