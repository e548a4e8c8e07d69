"""Downloads with the names of learning management systems: the student of each file, and the file that counts."""

from __future__ import annotations

import tempfile
import zipfile
from pathlib import Path

import pytest

from autograder.exceptions import UsageError
from autograder.lms.collect import CollectedSubmissions, collect, unpacked
from autograder.lms.roster import read_roster

CHAPTER = "02_nodes"
MOODLE = """Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,Last modified (grade)
Participant 101,Zoë Müller-Żak,zoe@example.edu,Submitted for grading,,100.00,Yes,
Participant 102,Jane  Doe,jane@example.edu,Submitted for grading - 2 hours 5 mins late - ,,100.00,Yes,
Participant 103,Bob Roe,bob@example.edu,No submission,,100.00,Yes,
"""
CANVAS = """Student,ID,SIS User ID,SIS Login ID,Section,02 Nodes (55)
    Points Possible,,,,,10
"Doe, Jane",7001,S1,jdoe,A,
"Müller, Zoë",7002,S2,zoe,A,
"Student, Test",7999,,,A,
"""


def download(folder: Path, *names: str) -> Path:
    """Write a download of files with these names; a name that ends in a slash is a folder."""
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith("/"):
            path.mkdir()
        else:
            path.write_text(name)
    return folder


def found(folder: Path, table: str) -> tuple[CollectedSubmissions, dict[str, str]]:
    roster = folder.parent / "roster.csv"
    roster.write_text(table, encoding="utf-8-sig")
    collected = collect(folder, read_roster(roster), CHAPTER, Path(tempfile.mkdtemp(dir=folder.parent)))
    return collected, {entry.student: located(entry.path, folder) for entry in collected.entries}


def located(path: Path, folder: Path) -> str:
    """Return where a submission lies in a download; the names of its files, where they were brought together."""
    if path.is_relative_to(folder):
        return str(path.relative_to(folder))
    return " + ".join(sorted(child.name for child in path.iterdir()))


def test_a_moodle_download_with_folders_is_assigned_to_students(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "moodle",
        "Zoë Müller-Żak_101_assignsubmission_file_/my answer.zip",
        "Zoë Müller-Żak_101_assignsubmission_onlinetext_/onlinetext.html",
        "Jane Doe_102_assignsubmission_file_/02_nodes.ipynb",
        "Jane Doe_102_assignsubmission_file_/ws/src/p/package.xml",
        "Eve Stranger_999_assignsubmission_file_/answer.zip",
    )
    collected, entries = found(folder, MOODLE)
    assert entries == {
        "zoe@example.edu": "Zoë Müller-Żak_101_assignsubmission_file_/my answer.zip",
        "jane@example.edu": "Jane Doe_102_assignsubmission_file_",
    }
    assert collected.late == ("jane@example.edu",)
    assert collected.missing == ("bob@example.edu",)
    assert collected.unmatched == (
        ("Eve Stranger_999_assignsubmission_file_", "no student of roster.csv fits"),
        ("Zoë Müller-Żak_101_assignsubmission_onlinetext_", "it is no file that was handed in"),
    )


def test_the_files_of_a_moodle_submission_without_folders_come_together(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "moodle",
        "Zoë Müller-Żak_101_assignsubmission_file_a_b.zip",
        "jane doe_102_assignsubmission_file_1.zip",
        "jane doe_102_assignsubmission_file_report-1.pdf",
        "jane doe_102_assignsubmission_file_report.pdf",
    )
    collected, entries = found(folder, MOODLE)
    assert entries["zoe@example.edu"] == "Zoë Müller-Żak_101_assignsubmission_file_a_b.zip"
    assert entries["jane@example.edu"] == "1.zip + report-1.pdf + report.pdf"
    assert (collected.older, collected.unmatched) == ((), ())


def test_the_name_of_a_moodle_file_cannot_make_it_another_students(tmp_path: Path) -> None:
    name = "Jane Doe_102_assignsubmission_file_x_101_assignsubmission_file_a.zip"
    collected, entries = found(download(tmp_path / "d", name), MOODLE)
    assert entries == {"jane@example.edu": name}
    assert collected.missing == ("zoe@example.edu", "bob@example.edu")


def test_a_canvas_download_names_attempts_and_late_submissions(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "canvas",
        "doejane_7001_9001_answer.zip",
        "doejane_LATE_7001_9005_answer-1.zip",
        "mllerzo_7002_9002_02_nodes.ipynb",
        "testsome_7003_9003_x.zip",
    )
    collected, entries = found(folder, CANVAS)
    assert entries == {"jdoe": "doejane_LATE_7001_9005_answer-1.zip", "zoe": "mllerzo_7002_9002_02_nodes.ipynb"}
    assert (collected.late, collected.older) == (("jdoe",), ("doejane_7001_9001_answer.zip",))
    assert [name for name, _ in collected.unmatched] == ["testsome_7003_9003_x.zip"]


def test_the_files_of_a_canvas_attempt_come_together_whatever_their_numbers(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "canvas",
        "doejane_7001_9001_work.zip",
        "doejane_7001_9002_screenshot.png",
        "mllerzo_7002_9003_part-1.zip",
        "mllerzo_7002_9004_part-2.zip",
    )
    collected, entries = found(folder, CANVAS)
    assert entries == {"jdoe": "screenshot.png + work.zip", "zoe": "part-1.zip + part-2.zip"}
    assert (collected.older, collected.unmatched) == ((), ())


def test_the_files_of_a_late_canvas_attempt_replace_those_of_one_in_time(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "canvas",
        "doejane_7001_9001_draft.zip",
        "doejane_7001_9002_notes.pdf",
        "doejane_LATE_7001_9005_final.zip",
        "doejane_LATE_7001_9006_notes-1.pdf",
    )
    collected, entries = found(folder, CANVAS)
    assert entries == {"jdoe": "final.zip + notes-1.pdf"}
    assert collected.older == ("doejane_7001_9001_draft.zip", "doejane_7001_9002_notes.pdf")


def test_each_member_of_a_gradescope_group_has_the_submission(tmp_path: Path) -> None:
    folder = download(tmp_path / "export", "submission_1/ws/src/p/package.xml", "submission_2/x", "notes.pdf")
    (folder / "submission_metadata.yml").write_text(
        "---\nsubmission_1:\n  :submitters:\n  - :name: Pair One\n    :sid: '200'\n  - :name: Pair Two\n"
        "    :sid: '201'\n  - :name: Guest\n    :sid: '9'\n  :created_at: 2026-01-03 09:00:00 Z\n"
        "submission_3:\n  :submitters:\n  - :name: Pair Two\n    :sid: '201'\n"
    )
    collected, entries = found(folder, "Name,SID,Email\nPair One,200,one@x.edu\nPair Two,201,two@x.edu\n")
    assert entries == {"200": "submission_1", "201": "submission_1"}
    assert collected.missing == ()
    assert collected.unmatched == (
        ("notes.pdf", "submission_metadata.yml does not list it"),
        ("submission_2", "submission_metadata.yml does not list it"),
        ("submission_3", "submission_metadata.yml lists it, and it is not there"),
        ("submission_1", "no student of roster.csv fits"),
    )


def test_the_list_of_a_gradescope_download_names_student_and_time_of_each_folder(tmp_path: Path) -> None:
    folder = download(
        tmp_path / "export", *(f"assignment_1_export/submission_{n}/ws/src/p/package.xml" for n in (1, 2, 3, 4))
    )
    rows = [("1", "S1", "2026-01-02 10:00:00"), ("2", "S1", "2026-01-03 09:00:00"), ("3", "S2", ""), ("4", "S9", "")]
    (folder / "assignment_1_export" / "submission_metadata.yml").write_text(
        "---\n"
        + "".join(
            f"submission_{n}:\n  :submitters:\n  - :name: Somebody\n    :sid: {sid}\n    :email: {sid}@x.edu\n"
            f"  :created_at: {when or '2026-01-01 08:00:00'} Z\n"
            for n, sid, when in rows
        )
    )
    collected, entries = found(folder, "Name,SID,Email\nJane,S1,j@x.edu\nZoë,S2,z@x.edu\n")
    assert entries == {"S1": "assignment_1_export/submission_2", "S2": "assignment_1_export/submission_3"}
    assert collected.older == ("submission_1",)
    assert [name for name, _ in collected.unmatched] == ["submission_4"]


def test_a_github_classroom_clone_is_assigned_by_the_account_in_its_name(tmp_path: Path) -> None:
    names = ("02-nodes-jane-doe/ws/src/p/x", "02-nodes-Zoe/ws/src/p/x", "02-nodes-doe/ws/src/p/x", "02-nodes-eve/x")
    folder = download(tmp_path / "02-nodes-submissions", *names)
    table = "identifier,github_username,github_id,name\njane,jane-doe,1,\nzoë,zoe,2,\ndoe,doe,3,\n"
    collected, entries = found(folder, table)
    assert entries == {"jane": "02-nodes-jane-doe", "zoë": "02-nodes-Zoe", "doe": "02-nodes-doe"}
    assert [name for name, _ in collected.unmatched] == ["02-nodes-eve"]


GITHUB = "identifier,github_username,github_id,name\nbob,bob,1,\neve,eve,2,\nzoë,ada-zoe,3,\n"


@pytest.mark.parametrize(
    ("folder", "names", "entries", "strangers"),
    [
        pytest.param(
            "hw-submissions",
            ["hw-ada-bob"],
            {},
            {"hw-ada-bob": "no student of roster.csv fits"},
            id="the folder says it",
        ),
        pytest.param(
            "clones",
            ["hw-ada-bob", "hw-eve"],
            {"eve": "hw-eve"},
            {"hw-ada-bob": "no student of roster.csv fits"},
            id="most clones begin so",
        ),
        pytest.param(
            "clones",
            ["hw-1-bob", "hw-1-eve", "hw-1-ada-zoe", "my-notes"],
            {"bob": "hw-1-bob", "eve": "hw-1-eve", "zoë": "hw-1-ada-zoe"},
            {"my-notes": "no student of roster.csv fits"},
            id="two accounts follow",
        ),
        pytest.param(
            "clones",
            ["02-nodes-ada-zoe"],
            {"zoë": "02-nodes-ada-zoe"},
            {},
            id="the course's own name of the assignment",
        ),
        pytest.param("clones", ["hw-ada-bob"], {}, {"hw-ada-bob": "unclear: bob, or an account"}, id="one clone"),
        pytest.param(
            "clones", ["hw-ada-zoe"], {}, {"hw-ada-zoe": "unclear: ada-zoe, or an"}, id="one of several names"
        ),
        pytest.param(
            "clones",
            ["hw-ada-bob", "hw-ada-zoe"],
            {},
            {"hw-ada-bob": "unclear: bob", "hw-ada-zoe": "unclear: ada-zoe"},
            id="as many fit after either",
        ),
    ],
)
def test_a_clone_is_nobodys_whose_account_only_ends_like_it(
    tmp_path: Path, folder: str, names: list[str], entries: dict[str, str], strangers: dict[str, str]
) -> None:
    collected, given = found(download(tmp_path / folder, *(f"{name}/ws/src/p/x" for name in names)), GITHUB)
    assert given == entries
    assert dict(collected.unmatched).keys() == strangers.keys()
    assert all(why in dict(collected.unmatched)[name] for name, why in strangers.items())


def test_the_layout_of_nbgrader_and_plain_names_are_assigned_to_students(tmp_path: Path) -> None:
    folder = download(tmp_path / "submitted", f"jane/{CHAPTER}/{CHAPTER}.ipynb", "Jo Bloggs.zip")
    _, entries = found(folder, "id,first_name,last_name,email\njane,,,\nJo Bloggs,,,\n")
    assert entries == {"jane": f"jane/{CHAPTER}", "Jo Bloggs": "Jo Bloggs.zip"}


def test_a_zip_is_unpacked_and_a_zip_with_paths_outside_its_folder_is_refused(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "good.zip", "w") as archive:
        archive.writestr("Zoë Müller-Żak_101_assignsubmission_file_/a.zip", "x")
    with unpacked(tmp_path / "good.zip") as folder:
        assert found(folder, MOODLE)[1] == {"zoe@example.edu": "Zoë Müller-Żak_101_assignsubmission_file_/a.zip"}
    with zipfile.ZipFile(tmp_path / "bad.zip", "w") as archive:
        archive.writestr("../x", "x")
    with pytest.raises(UsageError, match=r"bad.zip: not a folder, and not a readable zip: ../x points outside"):
        unpacked(tmp_path / "bad.zip").__enter__()
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize(
    ("table", "why"),
    [
        ("", "the table is empty"),
        ("Nachname,Note\nDoe,1\n", "no column names the students; the headings that are known are"),
        ("id,name\njane,a\njane,b\n", "two students are called jane"),
    ],
)
def test_a_table_that_names_no_students_is_a_wrong_call(tmp_path: Path, table: str, why: str) -> None:
    (tmp_path / "roster.csv").write_text(table)
    with pytest.raises(UsageError, match=why):
        read_roster(tmp_path / "roster.csv")
