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


def write_download(folder: Path, *names: str) -> Path:
    """Write a download of files with these names; a name that ends in a slash is a folder."""
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith("/"):
            path.mkdir()
        else:
            path.write_text(name)
    return folder


def collect_entries(folder: Path, table: str) -> tuple[CollectedSubmissions, dict[str, str]]:
    roster = folder.parent / "roster.csv"
    roster.write_text(table, encoding="utf-8-sig")
    collected = collect(folder, read_roster(roster), CHAPTER, Path(tempfile.mkdtemp(dir=folder.parent)))
    return collected, {student: location_in(path, folder) for student, path in collected.submissions.items()}


def location_in(path: Path, folder: Path) -> str:
    """Return a submission's path in a download, or the names of its files if they were copied into a new folder."""
    if path.is_relative_to(folder):
        return str(path.relative_to(folder))
    return " + ".join(sorted(child.name for child in path.iterdir()))


def test_a_moodle_download_with_folders_is_assigned_to_students(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "moodle",
        "Zoë Müller-Żak_101_assignsubmission_file_/my answer.zip",
        "Zoë Müller-Żak_101_assignsubmission_onlinetext_/onlinetext.html",
        "Jane Doe_102_assignsubmission_file_/02_nodes.ipynb",
        "Jane Doe_102_assignsubmission_file_/ws/src/p/package.xml",
        "Eve Stranger_999_assignsubmission_file_/answer.zip",
    )
    collected, entries = collect_entries(folder, MOODLE)
    assert entries == {
        "zoe@example.edu": "Zoë Müller-Żak_101_assignsubmission_file_/my answer.zip",
        "jane@example.edu": "Jane Doe_102_assignsubmission_file_",
    }
    assert collected.late == ("jane@example.edu",)
    assert collected.missing == ("bob@example.edu",)
    assert collected.unmatched == (
        ("Eve Stranger_999_assignsubmission_file_", "it matches no student in roster.csv"),
        ("Zoë Müller-Żak_101_assignsubmission_onlinetext_", "it is not a submitted file"),
    )


def test_the_files_of_a_moodle_submission_without_folders_are_gathered(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "moodle",
        "Zoë Müller-Żak_101_assignsubmission_file_a_b.zip",
        "jane doe_102_assignsubmission_file_1.zip",
        "jane doe_102_assignsubmission_file_report-1.pdf",
        "jane doe_102_assignsubmission_file_report.pdf",
    )
    collected, entries = collect_entries(folder, MOODLE)
    assert entries["zoe@example.edu"] == "Zoë Müller-Żak_101_assignsubmission_file_a_b.zip"
    assert entries["jane@example.edu"] == "1.zip + report-1.pdf + report.pdf"
    assert (collected.older, collected.unmatched) == ((), ())


def test_the_name_of_a_moodle_file_cannot_assign_it_to_another_student(tmp_path: Path) -> None:
    name = "Jane Doe_102_assignsubmission_file_x_101_assignsubmission_file_a.zip"
    collected, entries = collect_entries(write_download(tmp_path / "d", name), MOODLE)
    assert entries == {"jane@example.edu": name}
    assert collected.missing == ("zoe@example.edu", "bob@example.edu")


@pytest.mark.promise(
    "Downloads from Moodle, Canvas, Gradescope and GitHub Classroom are graded",
    "Canvas marks late submissions in their file names",
)
def test_a_canvas_download_names_attempts_and_late_submissions(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "canvas",
        "doejane_7001_9001_answer.zip",
        "doejane_LATE_7001_9005_answer-1.zip",
        "mllerzo_7002_9002_02_nodes.ipynb",
        "testsome_7003_9003_x.zip",
    )
    collected, entries = collect_entries(folder, CANVAS)
    assert entries == {"jdoe": "doejane_LATE_7001_9005_answer-1.zip", "zoe": "mllerzo_7002_9002_02_nodes.ipynb"}
    assert (collected.late, collected.older) == (("jdoe",), ("doejane_7001_9001_answer.zip",))
    assert [name for name, _ in collected.unmatched] == ["testsome_7003_9003_x.zip"]


def test_the_files_of_a_canvas_attempt_are_gathered_whatever_their_numbers(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "canvas",
        "doejane_7001_9001_work.zip",
        "doejane_7001_9002_screenshot.png",
        "mllerzo_7002_9003_part-1.zip",
        "mllerzo_7002_9004_part-2.zip",
    )
    collected, entries = collect_entries(folder, CANVAS)
    assert entries == {"jdoe": "screenshot.png + work.zip", "zoe": "part-1.zip + part-2.zip"}
    assert (collected.older, collected.unmatched) == ((), ())


@pytest.mark.promise("A late attempt replaces an earlier one that was on time.")
def test_the_files_of_a_late_canvas_attempt_replace_those_of_an_earlier_one(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "canvas",
        "doejane_7001_9001_draft.zip",
        "doejane_7001_9002_notes.pdf",
        "doejane_LATE_7001_9005_final.zip",
        "doejane_LATE_7001_9006_notes-1.pdf",
    )
    collected, entries = collect_entries(folder, CANVAS)
    assert entries == {"jdoe": "final.zip + notes-1.pdf"}
    assert collected.older == ("doejane_7001_9001_draft.zip", "doejane_7001_9002_notes.pdf")


BLACKBOARD = """Last Name,First Name,Username,Student ID,Availability
Doe,Jane,jdoe3,101,Yes
Roe,Bob,b_roe,102,Yes
Poe,Zoë,zpoe,103,Yes
"""


def write_receipts(folder: Path, **logins: str) -> None:
    """Write the first lines of Blackboard's receipts, by the beginning of their names."""
    for path in folder.glob("*_attempt_????-??-??-??-??-??.txt"):
        login = logins.get(path.name[0], "")
        path.write_text(f"Name: Some Body ({login})\nAssignment: Lab\nComments:\nName: Jane Doe (jdoe3)\n")


@pytest.mark.promise(
    "| Blackboard |",
    "A Blackboard receipt, a text file beside the submission, identifies the student.",
    "Text that a student typed in without attaching a file is listed, and the exit status is 1.",
)
def test_a_blackboard_download_contains_attempts_and_a_receipt_for_each(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "gradebook",
        "Chapter 13 Problems_jdoe3_attempt_2014-04-30-21-02-38.txt",
        "Chapter 13 Problems_jdoe3_attempt_2014-04-30-21-02-38_chapter (13).zip",
        "Chapter 13 Problems_jdoe3_attempt_2014-05-01-08-00-00.txt",
        "Chapter 13 Problems_jdoe3_attempt_2014-05-01-08-00-00_answer_2.zip",
        "Chapter 13 Problems_jdoe3_attempt_2014-05-01-08-00-00_notes.pdf",
        "Bb_nodes_b_roe_attempt_2014-04-30-21-02-38_x_jdoe3_attempt_2015-01-01-00-00-00_a.zip",
        "Bb_nodes_b_roe_attempt_2014-04-30-21-02-38.txt",
        "Z_nodes_zpoe_attempt_2014-04-30-21-02-38.txt",
        "E_nodes_eve_zpoe_attempt_2014-04-30-21-02-38_a.zip",
        "E_nodes_eve_zpoe_attempt_2014-04-30-21-02-38.txt",
        "No_zpoe_attempt_2014-04-30-21-02-38_a.zip",
    )
    write_receipts(folder, C="jdoe3", B="b_roe", Z="zpoe", E="eve_zpoe")
    collected, entries = collect_entries(folder, BLACKBOARD)
    assert entries == {
        "jdoe3": "answer_2.zip + notes.pdf",
        "b_roe": "Bb_nodes_b_roe_attempt_2014-04-30-21-02-38_x_jdoe3_attempt_2015-01-01-00-00-00_a.zip",
    }
    assert collected.older == ("Chapter 13 Problems_jdoe3_attempt_2014-04-30-21-02-38_chapter (13).zip",)
    assert collected.missing == ("zpoe",)
    assert dict(collected.unmatched) == {
        "E_nodes_eve_zpoe_attempt_2014-04-30-21-02-38.txt": "it matches no student in roster.csv",
        "E_nodes_eve_zpoe_attempt_2014-04-30-21-02-38_a.zip": "it matches no student in roster.csv",
        "No_zpoe_attempt_2014-04-30-21-02-38_a.zip": "unclear: its Blackboard receipt is missing, "
        "or names another student",
        "Z_nodes_zpoe_attempt_2014-04-30-21-02-38.txt": "it is not a submitted file",
    }


BRIGHTSPACE = """OrgDefinedId,Username,Last Name,First Name,Email,End-of-Line Indicator
#1001,#msmith,Smith,Mary-Ann,m@example.edu,#
#1002,#jdoe,Doe,John,j@example.edu,#
#1003,#egil,Gillotti,Eric,e@example.edu,#
#1004,#zoe,Poe,Zoë,z@example.edu,#
"""


@pytest.mark.promise("| Brightspace (D2L) |", "Brightspace names only the member who submitted")
def test_a_brightspace_download_names_the_student_and_the_time_in_folders_or_files(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "Lab 1 Download",
        "index.html",
        "397063-2557369 - Mary-Ann Smith - Sep 24, 2024 1126 AM/answer.zip",
        "397063-2557369 - Mary-Ann Smith - Sep 24, 2024 926 PM/answer.zip",
        "397063-2557369 - Group 1 - John Doe - Sep 24, 2024 926 PM/02_nodes.ipynb",
        "13394-80551 - Eric Gillotti - Mar 29, 2018 1205 PM - E - John Doe - Mar 30, 2018 100 PM - 6.zip",
        "13394-80551 - Eric Gillotti - Mar 29, 2018 1205 PM - notes.pdf",
        "13394-80551 - Eric Gillotti - Mar 29, 2018 1155 AM - draft.zip",
        "13394-80552 - 1004 - Mar 29, 2018 1155 - a.zip",
        "13394-80553 - Eve Stranger - 29 März 2018 - a.zip",
        "13394-80554 - Zoë Poe - Eve Stranger - Mar 29, 2018 1155 PM - a.zip",
    )
    collected, entries = collect_entries(folder, BRIGHTSPACE)
    assert entries == {
        "msmith": "397063-2557369 - Mary-Ann Smith - Sep 24, 2024 926 PM/answer.zip",
        "jdoe": "397063-2557369 - Group 1 - John Doe - Sep 24, 2024 926 PM/02_nodes.ipynb",
        "egil": "E - John Doe - Mar 30, 2018 100 PM - 6.zip + notes.pdf",
        "zoe": "13394-80552 - 1004 - Mar 29, 2018 1155 - a.zip",
    }
    assert collected.older == (
        "13394-80551 - Eric Gillotti - Mar 29, 2018 1155 AM - draft.zip",
        "397063-2557369 - Mary-Ann Smith - Sep 24, 2024 1126 AM",
    )
    assert [name for name, _ in collected.unmatched] == [
        "13394-80553 - Eve Stranger - 29 März 2018 - a.zip",
        "13394-80554 - Zoë Poe - Eve Stranger - Mar 29, 2018 1155 PM - a.zip",  # a group may have any name
    ]


SAKAI = """Lab 00,Points,,,
,,,,
Display ID,ID,Last Name,First Name,grade
llate2,llate2,Late,Laura,0.0
sspeedy2,sspeedy2,Speedy,Sam,0.0
nobody,nobody,Nix,Nora,0.0
typist,typist,Text,Tom,0.0
"""


@pytest.mark.promise("| Sakai |", "So does every student named in a Sakai folder's name.")
def test_a_sakai_download_has_a_folder_for_each_student_or_group(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "bulk_download",
        "Lab 00/grades.csv",
        "Lab 00/Late, Laura(llate2); Speedy, Sam (Sammy)(sspeedy2)/Submission attachment(s)/answer.zip",
        "Lab 00/Late, Laura(llate2); Speedy, Sam (Sammy)(sspeedy2)/Feedback Attachment(s)/marked.zip",
        "Lab 00/Late, Laura(llate2); Speedy, Sam (Sammy)(sspeedy2)/timestamp.txt",
        "Lab 00/Late, Laura(llate2); Speedy, Sam (Sammy)(sspeedy2)/comments.txt",
        "Lab 00/Nix, Nora(nobody)/Submission attachment(s)/",
        "Lab 00/Nix, Nora(nobody)/comments.txt",
        "Lab 00/Text, Tom(typist)/timestamp.txt",
        "Lab 00/Text, Tom(typist)/Text, Tom(typist)_submissionText.html",
        "Lab 00/Stranger, Eve(eve)/Submission attachment(s)/a.zip",
    )
    collected, entries = collect_entries(folder, SAKAI)
    answer = "Lab 00/Late, Laura(llate2); Speedy, Sam (Sammy)(sspeedy2)/Submission attachment(s)/answer.zip"
    assert entries == {"llate2": answer, "sspeedy2": answer}
    assert collected.missing == ("nobody", "typist")
    assert collected.unmatched == (
        ("Stranger, Eve(eve)", "it matches no student in roster.csv"),
        ("Text, Tom(typist)", "it is not a submitted file"),
    )


def test_a_sakai_download_without_folders_has_folder_names_in_its_file_names(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "bulk_download",
        "grades.csv",
        "Late, Laura(llate2)_Submission attachment(s)_work.zip",
        "Late, Laura(llate2)_Submission attachment(s)_report.pdf",
        "Late, Laura(llate2)__submissionText.html",
        "Speedy, Sam(sspeedy2)_Submission attachment(s)_x(nobody)_Submission attachment(s)_a.zip",
        "Text, Tom(typist)__submissionText.html",
    )
    collected, entries = collect_entries(folder, SAKAI)
    assert entries == {
        "llate2": "report.pdf + work.zip",
    }
    assert collected.unmatched == (
        (
            "Speedy, Sam(sspeedy2)_Submission attachment(s)_x(nobody)_Submission attachment(s)_a.zip",
            "it matches no student in roster.csv",
        ),
        ("Text, Tom(typist)__submissionText.html", "it is not a submitted file"),
    )


def test_a_name_that_resembles_a_download_does_not_replace_another_student(tmp_path: Path) -> None:
    moodle = 'Identifier,Full name\nParticipant 1,Ada Lovelace\nParticipant 2,"{}"\n'
    brightspace = 'OrgDefinedId,Name\n1,Ada Lovelace\n2,"{}"\n'
    sakai = 'Display ID,Last Name,First Name\nada,Lovelace,Ada\neve,"{}",\n'
    cases = [  # a table, Ada's item, Eve's name, Eve's item, and whether it is clearly hers
        (
            moodle,
            "Ada Lovelace_1_assignsubmission_file_/",
            "Eve_1_assignsubmission_file_",
            "{}_2_assignsubmission_file_/",
            True,
        ),
        (
            moodle,
            "Ada Lovelace_1_assignsubmission_file_/",
            "Eve_1_assignsubmission_file",
            "{}_2_assignsubmission_file/",
            True,
        ),
        (
            moodle,
            "Ada Lovelace_1_assignsubmission_file_a.zip",
            "Eve_1_assignsubmission_file_",
            "{}_2_assignsubmission_file_a.zip",
            True,
        ),
        (
            moodle,
            "Ada Lovelace_1_assignsubmission_file_a.zip",
            "Ada Lovelace_1_assignsubmission_file_",
            "{}_2_assignsubmission_file_a.zip",
            False,
        ),
        (
            brightspace,
            "1-2 - Ada Lovelace - Sep 24, 2026 926 PM/",
            "Ada Lovelace - Sep 25, 2026 926 PM",
            "3-2 - {} - Sep 23, 2026 1000 AM/",
            True,
        ),
        (
            brightspace,
            "1-2 - Ada Lovelace - Sep 24, 2026 926 PM - a.zip",
            "Ada Lovelace - Sep 25, 2026 926 PM",
            "3-2 - {} - Sep 23, 2026 1000 AM - a.zip",
            False,
        ),
        (
            sakai,
            "Lovelace, Ada(ada)_Submission attachment(s)_a.zip",
            "Lovelace, Ada(ada)_Submission attachment(s)_x",
            "{}, (eve)_Submission attachment(s)_a.zip",
            False,
        ),
        (
            sakai,
            "Lovelace, Ada(ada)/Submission attachment(s)/a.zip",
            "Lovelace, Ada(ada); Eve",
            "{}, (eve)/Submission attachment(s)/a.zip",
            False,
        ),
    ]
    for number, (table, ada_item, name, pattern, is_plain) in enumerate(cases):
        eve_item = pattern.format(name)
        folder = write_download(
            tmp_path / f"{number}" / "d",
            *(f"{path}answer.zip" if path[-1] == "/" else path for path in (ada_item, eve_item)),
        )
        _, entries = collect_entries(folder, table.format(name))
        ada = entries.pop(next(student for student, path in entries.items() if path.startswith(ada_item[:-1])))
        assert ada.startswith(ada_item), number
        assert [path.startswith(eve_item) for path in entries.values()] == [True] * is_plain, number


@pytest.mark.parametrize(
    "name", ["index.html", "earlier-marks.json", "handed_in.json", "results.json", "..", "x" * 256]
)
def test_a_student_whose_folder_conflicts_with_a_file_is_named(tmp_path: Path, name: str) -> None:
    folder = write_download(tmp_path / "d", "Ada_1_assignsubmission_file_a.zip", "Eve_2_assignsubmission_file_a.zip")
    collected, entries = collect_entries(folder, f"Identifier,Username\nParticipant 1,ada\nParticipant 2,{name}\n")
    assert list(entries) == ["ada"]
    (unmatched,) = collected.unmatched
    assert unmatched[0] == "Eve_2_assignsubmission_file_a.zip"
    assert unmatched[1].endswith("in roster.csv")


def test_each_member_of_a_gradescope_group_has_the_submission(tmp_path: Path) -> None:
    folder = write_download(tmp_path / "export", "submission_1/ws/src/p/package.xml", "submission_2/x", "notes.pdf")
    (folder / "submission_metadata.yml").write_text(
        "---\nsubmission_1:\n  :submitters:\n  - :name: Pair One\n    :sid: '200'\n  - :name: Pair Two\n"
        "    :sid: '201'\n  - :name: Guest\n    :sid: '9'\n  :created_at: 2026-01-03 09:00:00 Z\n"
        "submission_3:\n  :submitters:\n  - :name: Pair Two\n    :sid: '201'\n"
    )
    collected, entries = collect_entries(folder, "Name,SID,Email\nPair One,200,one@x.edu\nPair Two,201,two@x.edu\n")
    assert entries == {"200": "submission_1", "201": "submission_1"}
    assert collected.missing == ()
    assert collected.unmatched == (
        ("notes.pdf", "submission_metadata.yml does not list it"),
        ("submission_2", "submission_metadata.yml does not list it"),
        ("submission_3", "submission_metadata.yml lists it, but it is missing"),
        ("submission_1", "it matches no student in roster.csv"),
    )


@pytest.mark.promise("Downloads from Moodle, Canvas, Gradescope and GitHub Classroom are graded")
def test_the_list_of_a_gradescope_download_names_student_and_time_of_each_folder(tmp_path: Path) -> None:
    folder = write_download(
        tmp_path / "export", *(f"assignment_1_export/submission_{n}/ws/src/p/package.xml" for n in (1, 2, 3, 4))
    )
    rows = [("1", "S1", "2026-01-02 10:00:00"), ("2", "S1", "2026-01-03 09:00:00"), ("3", "S2", ""), ("4", "S9", "")]
    (folder / "assignment_1_export" / "submission_metadata.yml").write_text(
        "---\n"
        + "".join(
            f"submission_{n}:\n  :submitters:\n  - :name: Somebody\n    :sid: {sid}\n    :email: {sid}@x.edu\n"
            f"  :created_at: {created or '2026-01-01 08:00:00'} Z\n"
            for n, sid, created in rows
        )
    )
    collected, entries = collect_entries(folder, "Name,SID,Email\nJane,S1,j@x.edu\nZoë,S2,z@x.edu\n")
    assert entries == {"S1": "assignment_1_export/submission_2", "S2": "assignment_1_export/submission_3"}
    assert collected.older == ("submission_1",)
    assert [name for name, _ in collected.unmatched] == ["submission_4"]


@pytest.mark.promise(
    "Downloads from Moodle, Canvas, Gradescope and GitHub Classroom are graded", "| GitHub Classroom |"
)
def test_a_github_classroom_clone_is_assigned_by_the_account_in_its_name(tmp_path: Path) -> None:
    names = ("02-nodes-jane-doe/ws/src/p/x", "02-nodes-Zoe/ws/src/p/x", "02-nodes-doe/ws/src/p/x", "02-nodes-eve/x")
    folder = write_download(tmp_path / "02-nodes-submissions", *names)
    table = "identifier,github_username,github_id,name\njane,jane-doe,1,\nzoë,zoe,2,\ndoe,doe,3,\n"
    collected, entries = collect_entries(folder, table)
    assert entries == {"jane": "02-nodes-jane-doe", "zoë": "02-nodes-Zoe", "doe": "02-nodes-doe"}
    assert [name for name, _ in collected.unmatched] == ["02-nodes-eve"]


GITHUB = "identifier,github_username,github_id,name\nbob,bob,1,\neve,eve,2,\nzoë,ada-zoe,3,\n"


@pytest.mark.promise(
    "The name of a GitHub Classroom clone is ASSIGNMENT-ACCOUNT.",
    "In any other folder, ASSIGNMENT is the most frequent prefix of the clones",
    "If the account is ambiguous, the clone is listed as unclear.",
)
@pytest.mark.parametrize(
    ("folder", "names", "entries", "unmatched"),
    [
        pytest.param(
            "hw-submissions",
            ["hw-ada-bob"],
            {},
            {"hw-ada-bob": "it matches no student in roster.csv"},
            id="the folder names the assignment",
        ),
        pytest.param(
            "clones",
            ["hw-ada-bob", "hw-eve"],
            {"eve": "hw-eve"},
            {"hw-ada-bob": "it matches no student in roster.csv"},
            id="most clones have this prefix",
        ),
        pytest.param(
            "clones",
            ["hw-1-bob", "hw-1-eve", "hw-1-ada-zoe", "my-notes"],
            {"bob": "hw-1-bob", "eve": "hw-1-eve", "zoë": "hw-1-ada-zoe"},
            {"my-notes": "it matches no student in roster.csv"},
            id="two accounts follow the prefix",
        ),
        pytest.param(
            "clones",
            ["02-nodes-ada-zoe"],
            {"zoë": "02-nodes-ada-zoe"},
            {},
            id="the course's own name of the assignment",
        ),
        pytest.param("clones", ["hw-ada-bob"], {}, {"hw-ada-bob": "unclear: bob, or another account"}, id="one clone"),
        pytest.param(
            "clones", ["hw-ada-zoe"], {}, {"hw-ada-zoe": "unclear: ada-zoe, or an"}, id="one of several names"
        ),
        pytest.param(
            "clones",
            ["hw-ada-bob", "hw-ada-zoe"],
            {},
            {"hw-ada-bob": "unclear: bob", "hw-ada-zoe": "unclear: ada-zoe"},
            id="either prefix fits as many",
        ),
    ],
)
def test_a_clone_is_not_assigned_by_the_end_of_an_account_alone(
    tmp_path: Path, folder: str, names: list[str], entries: dict[str, str], unmatched: dict[str, str]
) -> None:
    collected, assigned = collect_entries(
        write_download(tmp_path / folder, *(f"{name}/ws/src/p/x" for name in names)), GITHUB
    )
    assert assigned == entries
    assert dict(collected.unmatched).keys() == unmatched.keys()
    assert all(reason in dict(collected.unmatched)[name] for name, reason in unmatched.items())


def test_the_layout_of_nbgrader_and_plain_names_are_assigned_to_students(tmp_path: Path) -> None:
    folder = write_download(tmp_path / "submitted", f"jane/{CHAPTER}/{CHAPTER}.ipynb", "Jo Bloggs.zip")
    _, entries = collect_entries(folder, "id,first_name,last_name,email\njane,,,\nJo Bloggs,,,\n")
    assert entries == {"jane": f"jane/{CHAPTER}", "Jo Bloggs": "Jo Bloggs.zip"}


def test_a_zip_is_unpacked_and_a_zip_with_paths_outside_its_folder_is_refused(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "good.zip", "w") as archive:
        archive.writestr("Zoë Müller-Żak_101_assignsubmission_file_/a.zip", "x")
    with unpacked(tmp_path / "good.zip") as folder:
        assert collect_entries(folder, MOODLE)[1] == {
            "zoe@example.edu": "Zoë Müller-Żak_101_assignsubmission_file_/a.zip"
        }
    with zipfile.ZipFile(tmp_path / "bad.zip", "w") as archive:
        archive.writestr("../x", "x")
    with pytest.raises(UsageError, match=r"bad.zip: not a folder, and not a readable zip: ../x points outside"):
        unpacked(tmp_path / "bad.zip").__enter__()
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize(
    ("table", "reason"),
    [
        ("", "the table is empty"),
        ("Nachname,Note\nDoe,1\n", "no column identifies the students; the known headings are"),
        ("id,name\njane,a\njane,b\n", "two students are called jane"),
    ],
)
def test_a_table_without_students_is_a_usage_error(tmp_path: Path, table: str, reason: str) -> None:
    (tmp_path / "roster.csv").write_text(table)
    with pytest.raises(UsageError, match=reason):
        read_roster(tmp_path / "roster.csv")


def test_the_times_of_submissions_are_those_of_the_newest_attempts(tmp_path: Path) -> None:
    folder = write_download(tmp_path / "export", "submission_1/a.zip", "submission_2/b.zip")
    (folder / "submission_metadata.yml").write_text(
        "submission_1:\n  :submitters: [{':sid': '101'}]\n  :created_at: 2026-05-04 18:00:00.5 -05:00\n"
        "submission_2:\n  :submitters: [{':sid': '102'}]\n"
    )
    collected, _ = collect_entries(folder, "SID,Name\n101,Ada\n102,Bob\n")
    assert collected.times == {"101": "2026-05-04 18:00:00.500000-05:00"}
    folder = write_download(
        tmp_path / "gradebook",
        "C_jdoe3_attempt_2014-04-30-21-02-38_old.zip",
        "C_jdoe3_attempt_2014-05-01-08-00-00_new.zip",
        "C_jdoe3_attempt_2014-04-30-21-02-38.txt",
        "C_jdoe3_attempt_2014-05-01-08-00-00.txt",
    )
    write_receipts(folder, C="jdoe3")
    assert collect_entries(folder, BLACKBOARD)[0].times == {"jdoe3": "2014-05-01 08:00:00"}
    folder = write_download(tmp_path / "d2l", "1-2 - Jane Doe - Nov 9, 2025 1205 AM - a.zip")
    assert collect_entries(folder, BLACKBOARD)[0].times == {"jdoe3": "2025-11-09 00:05"}


@pytest.mark.parametrize(
    ("status", "late_by"),
    [
        ("Submitted for grading", None),
        ("Submitted for grading - 1 day 2 hours late", 93_600),
        ("Submitted for grading - 2 hours 5 mins late - Extension granted until: Monday, 4 May 2026, 18:00", 7_500),
        ("Graded - 1 min 1 sec late", 61),
        ("Submitted for grading - 1 year 35 days late", 34_560_000),
    ],
)
def test_moodles_table_says_how_late_a_submission_is(tmp_path: Path, status: str, late_by: int | None) -> None:
    folder = write_download(tmp_path / "moodle", "Zoë Müller-Żak_101_assignsubmission_file_/a.zip")
    collected, _ = collect_entries(folder, MOODLE.replace("Submitted for grading,", f'"{status}",', 1))
    assert collected.late_by == ({} if late_by is None else {"zoe@example.edu": late_by})
    assert collected.late == (() if late_by is None else ("zoe@example.edu",))
