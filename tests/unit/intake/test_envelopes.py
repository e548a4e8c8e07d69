"""One correct answer, in each form in which tools, systems and people hand it in: the graded content is the same.

The names come from what users of other tools reported: otter-grader and abc-classroom (renamed notebooks), jupytext
(minor versions with ids), nbgrader ("WMS q3.ipynb"), submit50 (environments), canvas-unzipper (downloads of Canvas),
BBGradebookOrganiser (7z, RAR, __MACOSX, node_modules), bb-file-cleanup (downloads of Blackboard), kodiak and GradeFast
(of Brightspace), and Sakai's own source and programs that read its folders.
"""

from __future__ import annotations

import bz2
import gzip
import json
import os
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.lms.collect import collect
from autograder.lms.roster import read_roster
from autograder.submission.intake import Submission, read_submission
from tests.answers import BOOK, CHAPTER, TARGET, Answer, Files, filled, make_answer, tarred, write, zipped


@pytest.fixture(scope="session")
def answer(tmp_path_factory: pytest.TempPathFactory) -> Answer:
    return make_answer(tmp_path_factory.mktemp("release"))


@pytest.fixture(scope="session")
def plain_answer(answer: Answer, tmp_path_factory: pytest.TempPathFactory) -> Submission:
    return read_submission(write(tmp_path_factory.mktemp("plain") / "ada", answer.files), CHAPTER)


def below(prefix: str, files: Files) -> dict[str, bytes]:
    return {f"{prefix}/{name}": data for name, data in files.items()}


def without(files: Files, *prefixes: str) -> dict[str, bytes]:
    return {name: data for name, data in files.items() if not name.startswith(prefixes)}


def sources(files: Files) -> dict[str, bytes]:
    return {name.removeprefix("ws/"): data for name, data in files.items() if name.startswith("ws/src/")}


def environment(name: str, count: int = 30, **other_files: bytes) -> dict[str, bytes]:
    return below(name, {f"lib/python3.12/site-packages/m{n}.py": b"x" for n in range(count)} | other_files)


def minor_4(notebook: dict[str, Any]) -> None:
    notebook["nbformat_minor"] = 4


def no_ids(notebook: dict[str, Any]) -> None:
    minor_4(notebook)
    for cell in notebook["cells"]:
        cell.pop("id", None)


def nameless_output(notebook: dict[str, Any]) -> None:
    code(notebook)[0]["outputs"] = [{"output_type": "stream", "text": ["hi"]}]


def no_outputs(notebook: dict[str, Any]) -> None:
    for cell in code(notebook):
        cell.pop("outputs", None)
        cell.pop("execution_count", None)


def unknown_keys(notebook: dict[str, Any]) -> None:
    notebook["colab"] = {}
    for cell in notebook["cells"]:
        cell["vscode"] = {"languageId": "python"}


def no_marks(notebook: dict[str, Any]) -> None:
    notebook["metadata"] = {"colab": {"provenance": []}}
    for cell in notebook["cells"]:
        cell["metadata"] = {"id": "x"}
        cell.pop("id", None)


def no_metadata(notebook: dict[str, Any]) -> None:
    for cell in notebook["cells"]:
        cell.pop("metadata", None)


def twin_ids(notebook: dict[str, Any]) -> None:
    for cell in notebook["cells"]:
        cell["id"] = "same"


def text_in_one_piece(notebook: dict[str, Any]) -> None:
    for cell in notebook["cells"]:
        cell["source"] = "".join(cell["source"])


def large_outputs(notebook: dict[str, Any]) -> None:
    code(notebook)[0]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["x" * 79 + "\n"] * 260_000}]


def windows_cells(notebook: dict[str, Any]) -> None:
    for cell in notebook["cells"]:
        cell["source"] = "".join(cell["source"]).replace("\n", "\r\n")


def code(notebook: dict[str, Any]) -> list[dict[str, Any]]:
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


# The files in the student's folder.
FOLDERS: dict[str, Callable[[Answer], Files]] = {
    "written in the cell, never run": lambda a: a.cells,
    "written in the editor": lambda a: a.editor,
    "an older draft in the cell": lambda a: {**a.files, BOOK: filled(a.released[BOOK], "draft = True\n")},
    "the stub was run, the answer was not": lambda a: {
        **a.cells,
        TARGET: stub_file(a.released[BOOK]),
    },
    "packages alone": lambda a: without(a.files, BOOK, "figures"),
    "src alone": lambda a: sources(a.files),
    "src beside the notebook": lambda a: {BOOK: a.released[BOOK], **sources(a.files)},
    "packages without src": lambda a: {k.removeprefix("src/"): v for k, v in sources(a.files).items()},
    "02_nodes (1).ipynb": lambda a: {**without(a.cells, BOOK), "02_nodes (1).ipynb": a.files[BOOK]},
    "02_nodes (1).ipynb beside the untouched one": lambda a: {**a.released, "02_nodes (1).ipynb": a.files[BOOK]},
    "02_nodes-Copy1.ipynb beside the untouched one": lambda a: {**a.released, "02_nodes-Copy1.ipynb": a.files[BOOK]},
    "Copy of 02_nodes.ipynb": lambda a: {**without(a.cells, BOOK), "Copy of 02_nodes.ipynb": a.files[BOOK]},
    "02_nodes - Copy.ipynb and an equal one": lambda a: {**a.cells, "02_nodes - Copy.ipynb": a.files[BOOK]},
    "02_nodes copy 2.ipynb": lambda a: {**without(a.cells, BOOK), "02_nodes copy 2.ipynb": a.files[BOOK]},
    "02_Nodes.IPYNB": lambda a: {**without(a.cells, BOOK), "02_Nodes.IPYNB": a.files[BOOK]},
    "02_nodes.ipynb.txt": lambda a: {**without(a.cells, BOOK), "02_nodes.ipynb.txt": a.files[BOOK]},
    "02_nodes.ipynb.json": lambda a: {**without(a.cells, BOOK), "02_nodes.ipynb.json": a.files[BOOK]},
    "another name": lambda a: {**without(a.cells, BOOK), "WMS q3.ipynb": a.files[BOOK]},
    "another name beside the untouched one": lambda a: {**a.released, "final.ipynb": a.files[BOOK]},
    "a notebook of another chapter, too": lambda a: {**a.files, "01_package_structure.ipynb": a.released[BOOK]},
    "a broken copy of the notebook, too": lambda a: {**a.cells, "02_nodes (2).ipynb": b"{"},
    "a broken notebook, and all files": lambda a: {**a.files, BOOK: b"<<<<<<< HEAD\n{}"},
    "the release and a folder with the answer": lambda a: {**a.released, **below("my work", a.files)},
    "a folder in a folder": lambda a: below(f"ada/{CHAPTER}", a.files),
    "five folders deep": lambda a: below(f"home/ada/Desktop/ROS 2/{CHAPTER}", a.files),
    "the whole course": lambda a: {
        **below(f"course/chapters/{CHAPTER}", a.files),
        **below("course/chapters/01_package_structure", {"ws/src/square_dance/package.xml": b"<package/>"}),
        **below("course", {"README.md": b"", "sim/x.py": b"", "src/tool/setup.py": b""}),
    },
    "an older copy below": lambda a: {**a.files, "old/02_nodes.ipynb": filled(a.released[BOOK], "old = True\n")},
    "a zip": lambda a: {"answer.zip": zipped(a.files)},
    "X.ZIP": lambda a: {"X.ZIP": zipped(a.files)},
    "a zip and a readme": lambda a: {"answer.zip": zipped(a.files), "README.txt": b"see zip"},
    "a zip beside its own files": lambda a: {**a.files, "02_nodes.zip": zipped(a.files)},
    "a zip beside the release": lambda a: {**a.released, "02_nodes.zip": zipped(a.files)},
    "a zip in a zip": lambda a: {"outer.zip": zipped({"inner.zip": zipped(a.files, f"{CHAPTER}/")})},
    "a zip in a tar in a zip": lambda a: {"o.zip": zipped({"m.tgz": tarred({"i.zip": zipped(a.files)}, mode="w:gz")})},
    "a notebook and a zip of ws": lambda a: {
        BOOK: a.files[BOOK],
        "ws.zip": zipped({k: v for k, v in a.files.items() if k.startswith("ws/")}),
    },
    "a notebook and a report": lambda a: {**a.cells, "a.pdf": b"%PDF-1.7", "b.docx": zipped({"w": b""})},
    "a screenshot": lambda a: {**a.files, "Screenshot 2026-01-03 at 09.00.00.png": b"\x89PNG"},
    "a loose copy of the file": lambda a: {**a.cells, "robot_controller.py": b"# my file\n"},
    "a large video": lambda a: {**a.files, "drive.mp4": bytes(17 * 2**20)},
    "a 7z of it, too": lambda a: {**a.files, "backup.7z": b"7z\xbc\xaf\x27\x1c"},
    "build products": lambda a: {**a.files, "ws/build/x": b"", "ws/install/y": b"", "ws/log/z": b"", "build/x": b""},
    "caches": lambda a: {**a.files, ".mypy_cache/x": b"", "ws/src/my_robot_package/__pycache__/x.pyc": b""},
    "checkpoints": lambda a: {**a.files, ".ipynb_checkpoints/02_nodes-checkpoint.ipynb": a.released[BOOK]},
    ".git": lambda a: {**a.files, **below(".git", {f"objects/{n}": b"x" for n in range(2100)})},
    "system files": lambda a: {
        **a.files, ".DS_Store": b"", "Thumbs.db": b"", "desktop.ini": b"", "ws/src/._x": b"", "__MACOSX/._02": b""
    },
    "node_modules": lambda a: {**a.files, **below("node_modules", {f"m{n}/i.js": b"" for n in range(2100)})},
    ".venv": lambda a: {**a.files, **environment(".venv", 2100)},
    "venv": lambda a: {**a.files, **environment("venv", 2100)},
    "env, known by pyvenv.cfg": lambda a: {**a.files, **environment("env", 2100, **{"pyvenv.cfg": b"home = /usr"})},
    "a conda environment": lambda a: {**a.files, **environment("ros", 2100, **{"conda-meta/history": b""})},
    "an environment in the folder itself": lambda a: {
        **a.files, "pyvenv.cfg": b"", "bin/python": b"", "lib/python3.12/src/x.py": b"", "include/x.h": b""
    },
    "an environment in ws": lambda a: {**a.files, **environment("ws/.venv", 50)},
    "a byte order mark": lambda a: {**a.cells, BOOK: b"\xef\xbb\xbf" + a.files[BOOK]},
    "UTF-16": lambda a: {**a.cells, BOOK: a.files[BOOK].decode().encode("utf-16")},
    "windows line ends": lambda a: {**a.cells, BOOK: a.files[BOOK].replace(b"\n", b"\r\n")},
}  # fmt: skip

# The notebook, with the answer in its cell alone.
NOTEBOOKS: dict[str, Callable[[dict[str, Any]], None]] = {
    "nbformat 4.4 with cell ids": minor_4,
    "nbformat 4.4 without cell ids": no_ids,
    "an output without a name": nameless_output,
    "code cells without outputs": no_outputs,
    "unknown keys": unknown_keys,
    "nbgrader's metadata dropped": no_marks,
    "cells without metadata": no_metadata,
    "equal cell ids": twin_ids,
    "text in one piece": text_in_one_piece,
    "20 MB of outputs": large_outputs,
    "windows line ends in cells": windows_cells,
}

# The file that holds the folder.
ARCHIVES: dict[str, Callable[[Answer], bytes]] = {
    "ada.zip": lambda a: zipped(a.files),
    "ADA.ZIP": lambda a: zipped(a.files, f"{CHAPTER}/"),
    "stored.zip": lambda a: zipped(a.files, compression=zipfile.ZIP_STORED),
    "lzma.zip": lambda a: zipped(a.files, compression=zipfile.ZIP_LZMA),
    "windows.zip": lambda a: zipped({name.replace("/", "\\"): data for name, data in a.files.items()}),
    "mac.zip": lambda a: zipped({**a.files, "__MACOSX/ws/src/._x": b"\0\5\26\7", ".DS_Store": b""}),
    "with a .venv.zip": lambda a: zipped({**a.files, **environment(".venv", 2100)}),
    "nested.zip": lambda a: zipped({"02_nodes.zip": zipped(a.files)}),
    "no ending": lambda a: zipped(a.files),
    "ada.tar": lambda a: tarred(a.files),
    "ada.tar.gz": lambda a: tarred(a.files, f"./{CHAPTER}/", "w:gz"),
    "ada.TGZ": lambda a: tarred(a.files, mode="w:gz"),
    "ada.tar.bz2": lambda a: tarred(a.files, mode="w:bz2"),
    "ada.tar.xz": lambda a: tarred(a.files, mode="w:xz"),
    "with an env.tar.gz": lambda a: tarred({**environment("my", 2100, **{"pyvenv.cfg": b""}), **a.files}, mode="w:gz"),
    "notebook.ipynb": lambda a: a.files[BOOK],
    "02_nodes (3).IPYNB": lambda a: a.files[BOOK],
    "02_nodes.ipynb.txt": lambda a: a.files[BOOK],
    "02_nodes.ipynb.gz": lambda a: gzip.compress(a.files[BOOK]),
    "02_nodes.ipynb.bz2": lambda a: bz2.compress(a.files[BOOK]),
    "renamed.zip": lambda a: zipped({"02_nodes-1.ipynb": a.files[BOOK]}),
}

ROSTER = """Username,Student ID,Last Name,First Name,ID
jdoe3,101,Doe,Jane,jdoe3
broe,102,Roe,Bob,broe
"""
BLACKBOARD = "Chapter 13 Problems_jdoe3_attempt_2014-04-30-21-02-38"
LATER = "Chapter 13 Problems_jdoe3_attempt_2014-05-01-00-00-00"
RECEIPT = b"Name: Jane Doe (jdoe3)\nAssignment: Chapter 13 Problems\n"
BRIGHTSPACE = "397063-2557369 - Jane Doe - Sep 24, 2024"
SAKAI = "Lab 00/Doe, Jane(jdoe3)"

# The download of a class, with the submission of the student jdoe3 in it, and perhaps an older one.
DOWNLOADS: dict[str, Callable[[Answer], Files]] = {
    "Blackboard, a zip": lambda a: {f"{BLACKBOARD}.txt": RECEIPT, f"{BLACKBOARD}_a (1).zip": zipped(a.files)},
    "Blackboard, the newer of two attempts": lambda a: {
        f"{BLACKBOARD}.txt": RECEIPT,
        f"{BLACKBOARD}_02_nodes.ipynb": filled(a.released[BOOK], "old = True\n"),
        f"{LATER}.txt": RECEIPT,
        f"{LATER}_02_nodes.ipynb": a.files[BOOK],
        f"{LATER}_notes.pdf": b"%PDF",
    },
    "Brightspace, a folder": lambda a: {"index.html": b"", f"{BRIGHTSPACE} 926 PM/02_nodes.ipynb": a.files[BOOK]},
    "Brightspace, the newer of two folders": lambda a: {
        f"{BRIGHTSPACE} 926 PM/X.ZIP": zipped(a.files),
        f"{BRIGHTSPACE} 1126 AM/X.ZIP": zipped({**a.files, TARGET: b"old = True\n"}),
    },
    "Brightspace, files": lambda a: {f"{BRIGHTSPACE} 1205 PM - EGillotti - Homework 6.zip": zipped(a.files)},
    "Sakai, folders": lambda a: {
        "Lab 00/grades.csv": b"",
        f"{SAKAI}/timestamp.txt": b"201701271144002",
        f"{SAKAI}/Submission attachment(s)/02_nodes.zip": zipped(a.files),
        f"{SAKAI}/Feedback Attachment(s)/02_nodes.zip": zipped({**a.files, TARGET: b"# 3 of 5\n"}),
        **below("Lab 00/Roe, Bob(broe)/Submission attachment(s)", a.files),
    },
    "Sakai, no folders": lambda a: {
        "Doe, Jane(jdoe3)_Submission attachment(s)_02_nodes.ipynb": a.files[BOOK],
        "Doe, Jane(jdoe3)__submissionText.html": b"",
    },
}


def stub_file(released: bytes) -> bytes:
    """Return the file that the untouched cell writes."""
    cells = json.loads(released)["cells"]
    texts = ("".join(cell["source"]) for cell in cells)
    return next(text for text in texts if text.startswith(f"%%writefile {TARGET}\n")).partition("\n")[2].encode()


@pytest.mark.promise(
    "If a file is missing or unchanged, it is taken from the notebook's cell.",
    "If a file is missing or unchanged since the release, it is taken from the notebook's cell.",
)
@pytest.mark.parametrize("envelope", FOLDERS)
def test_a_folder_is_graded_like_the_plain_answer(
    envelope: str, answer: Answer, plain_answer: Submission, tmp_path: Path
) -> None:
    _expect_same(read_submission(write(tmp_path / "ada", FOLDERS[envelope](answer)), CHAPTER), plain_answer)


@pytest.mark.parametrize("change", NOTEBOOKS)
@pytest.mark.parametrize("location", ["alone", "in its folder"])
def test_a_notebook_is_graded_like_the_plain_answer(
    change: str, location: str, answer: Answer, plain_answer: Submission, tmp_path: Path
) -> None:
    notebook = {BOOK: answer.notebook(NOTEBOOKS[change])}
    folder = write(tmp_path / "ada", notebook if location == "alone" else {**answer.released, **notebook})
    _expect_same(read_submission(folder, CHAPTER), plain_answer)


@pytest.mark.parametrize("name", ARCHIVES)
def test_a_file_is_graded_like_the_plain_answer(
    name: str, answer: Answer, plain_answer: Submission, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(ARCHIVES[name](answer))
    _expect_same(read_submission(tmp_path / name, CHAPTER), plain_answer)


@pytest.mark.parametrize("name", DOWNLOADS)
def test_a_download_contains_the_plain_answer_of_its_student(
    name: str, answer: Answer, plain_answer: Submission, tmp_path: Path
) -> None:
    (tmp_path / "roster.csv").write_text(ROSTER)
    (tmp_path / "scratch").mkdir()
    folder = write(tmp_path / "download", DOWNLOADS[name](answer))
    collected = collect(folder, read_roster(tmp_path / "roster.csv"), CHAPTER, tmp_path / "scratch")
    assert collected.unmatched == ()
    assert next(iter(collected.submissions)) == "jdoe3"
    for path in collected.submissions.values():
        _expect_same(read_submission(path, CHAPTER), plain_answer)


def _package(submission: Submission) -> dict[str, bytes]:
    files = submission.packages or ()
    return {str(file.path): file.data for file in files if file.path.parts[0] == "my_robot_package"}


def _expect_same(submission: Submission, plain_answer: Submission) -> None:
    assert submission.packages is not None
    assert plain_answer.packages is not None
    assert _package(submission) == _package(plain_answer)
    if submission.notebook is not None:  # its cells also write the packages that the chapter shows
        assert submission.graded_sha256 == plain_answer.graded_sha256


def test_a_link_outside_of_the_packages_is_left_out_and_named(
    answer: Answer, plain_answer: Submission, tmp_path: Path
) -> None:
    folder = write(tmp_path / "ada", answer.files)
    (folder / "latest").symlink_to("/etc/passwd")
    (folder / ".venv" / "bin").mkdir(parents=True)
    (folder / ".venv" / "bin" / "python").symlink_to("/usr/bin/python3")
    os.mkfifo(folder / "pipe")
    submission = read_submission(folder, CHAPTER)
    _expect_same(submission, plain_answer)
    assert submission.unused == ("latest is a symbolic link", "pipe is not a regular file")


@pytest.mark.promise("Screenshots, reports and readme files beside the answer are listed but not used.")
def test_each_unused_file_is_named(answer: Answer, tmp_path: Path) -> None:
    files = {
        **answer.released,
        "02_nodes (1).ipynb": answer.files[BOOK],
        "report.pdf": b"",
        "old.rar": b"Rar!\x1a\x07\0",
    }
    submission = read_submission(write(tmp_path / "ada", files), CHAPTER)
    assert submission.unused == (
        BOOK,
        "report.pdf",
        "old.rar is a RAR archive, which the grader does not open: unpack it, and hand in the folder as a zip",
    )


OTHER = b"other = True\n"
UNCLEAR: dict[str, tuple[Callable[[Answer], Files], str]] = {
    "two different notebooks": (
        lambda a: {**a.cells, "02_nodes (1).ipynb": filled(a.released[BOOK], OTHER.decode())},
        "holds 2 notebooks with different answers, 02_nodes (1).ipynb, 02_nodes.ipynb. Hand in the one that counts",
    ),
    "two different folders": (
        lambda a: {**below("a", a.files), **below("b", {**a.files, TARGET: OTHER})},
        "holds 2 source trees with different answers, a/ws/src, b/ws/src",
    ),
    "two different zips": (
        lambda a: {"1.zip": zipped(a.files), "2.zip": zipped({**a.files, TARGET: OTHER})},
        "holds 2 source trees with different answers, 1.zip/ws/src, 2.zip/ws/src",
    ),
    "a 7z alone": (lambda a: {"ada.7z": b"7z\xbc\xaf\x27\x1c"}, "ada.7z is a 7z archive, which the grader does"),
    "a RAR beside the release": (lambda a: {**a.released, "a.rar": b"Rar!\x1a\x07\1"}, "a.rar is a RAR archive"),
    "a damaged zip beside the release": (lambda a: {**a.released, "a.zip": b"PK\3\4"}, "a.zip cannot be opened"),
    "a cut notebook": (lambda a: {**a.released, BOOK: a.files[BOOK][:9000]}, "02_nodes.ipynb cannot be read"),
    "a cut notebook beside the untouched one": (
        lambda a: {**a.released, "02_nodes (1).ipynb": a.files[BOOK][:9000]},
        "02_nodes (1).ipynb cannot be read",
    ),
    "an essay": (lambda a: {"essay.docx": zipped({"word/document.xml": b""})}, "There is nothing to grade"),
    "an empty folder": (lambda a: {}, "There is nothing to grade"),
}  # fmt: skip


@pytest.mark.promise(
    "For 7z, RAR and Zstandard, a message asks you to unpack them.", "A submission is *unclear* if it cannot be opened"
)
@pytest.mark.parametrize("envelope", UNCLEAR)
def test_an_unclear_file_that_may_contain_an_answer_has_a_remedy(envelope: str, answer: Answer, tmp_path: Path) -> None:
    files, message = UNCLEAR[envelope]
    with pytest.raises(StudentError) as excinfo:
        read_submission(write(tmp_path / "ada", files(answer)), CHAPTER)
    diagnosis = excinfo.value.diagnosis
    assert message in diagnosis.sentence
    assert diagnosis.kind in (Kind.UNCLEAR, Kind.UNREADABLE, Kind.NOTHING_SUBMITTED)
    assert any(word in diagnosis.sentence.casefold() for word in ("hand in", "hand it in", "cannot be opened"))


def test_an_untouched_release_is_graded(answer: Answer, tmp_path: Path) -> None:
    submission = read_submission(write(tmp_path / "ada", answer.released), CHAPTER)
    assert submission.packages is not None
    assert TARGET.removeprefix("ws/src/") in {str(file.path) for file in submission.packages}
