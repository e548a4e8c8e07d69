"""Submissions are read, or refused with a reason."""

from __future__ import annotations

import io
import os
import stat
import struct
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from typing import Any

import pytest
from hypothesis import event, given
from hypothesis import strategies as st

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError, UsageError
from autograder.run.sandbox.worker_sandbox import copy_submission
from autograder.submission import intake
from autograder.submission.intake import (
    SubmittedFile,
    compression,
    detect_layout,
    read_packages,
    read_submission,
    reading,
    write_tree,
    zip_directory,
)
from autograder.submission.intake.notebooks import without_outputs

CHAPTER = "02_nodes"
NOTEBOOK = b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": []}'
TREE = {
    f"{CHAPTER}.ipynb": NOTEBOOK,
    "notes.txt": b"mine",
    "ws/src/my_robot_package/package.xml": b"<package/>",
    "ws/src/my_robot_package/setup.py": b"setup()\r\n",
}
SOURCE = {"my_robot_package/package.xml", "my_robot_package/setup.py"}


def _write(root: Path, files: dict[str, bytes]) -> Path:
    for name, data in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_bytes(data)
    return root


def _zip(path: Path, files: dict[str, bytes], prefix: str = "") -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(prefix + name, data)
    return path


def _names(entries: tuple[SubmittedFile, ...]) -> set[str]:
    return {str(entry.path) for entry in entries}


def _refusal(path: Path) -> tuple[Kind, str]:
    with pytest.raises(StudentError) as excinfo:
        read_submission(path, CHAPTER)
    return excinfo.value.diagnosis.kind, excinfo.value.diagnosis.sentence


# Every layout.


@pytest.mark.promise(
    "A submission is the student's folder, a zip or tar archive of it, the notebook alone, or a source tree."
)
@pytest.mark.parametrize("layout", ["folder", "folder in a folder", "zip", "zip with a top folder", "zip by two"])
def test_a_whole_folder_is_recognised_however_it_is_packed(tmp_path: Path, layout: str) -> None:
    if layout.startswith("folder"):
        root = tmp_path / "alice"
        _write(root / CHAPTER if "in a" in layout else root, TREE)
        submission = read_submission(root, CHAPTER)
    else:
        prefix = {"zip": "", "zip with a top folder": f"{CHAPTER}/", "zip by two": f"alice/{CHAPTER}/"}[layout]
        submission = read_submission(_zip(tmp_path / "alice.zip", TREE, prefix), CHAPTER)
    assert submission.notebook == NOTEBOOK
    assert _names(submission.source) == SOURCE
    assert _names(submission.extra) == {"notes.txt"}


def test_a_lone_notebook_may_have_any_name(tmp_path: Path) -> None:
    (tmp_path / "my answer.ipynb").write_bytes(NOTEBOOK)
    submission = read_submission(tmp_path / "my answer.ipynb", CHAPTER)
    assert (submission.notebook, submission.source, submission.extra) == (NOTEBOOK, (), ())


@pytest.mark.promise(
    "A submission is the student's folder, a zip or tar archive of it, the notebook alone, or a source tree."
)
def test_a_bare_source_tree_has_no_notebook(tmp_path: Path) -> None:
    submission = read_submission(_write(tmp_path / "bob", {"src/pkg/package.xml": b"x"}), CHAPTER)
    assert submission.notebook is None
    assert _names(submission.source) == {"pkg/package.xml"}


def test_ws_src_is_preferred_to_a_folder_called_src_beside_it(tmp_path: Path) -> None:
    submission = read_submission(_write(tmp_path / "bob", {"ws/src/pkg/a": b"1", "src/pkg/a": b"2"}), CHAPTER)
    assert [(str(entry.path), entry.data) for entry in submission.source] == [("pkg/a", b"1")]


@pytest.mark.promise("Folders named `build`, `install` and `log` are not needed")
def test_files_that_colcon_and_python_generate_are_ignored(tmp_path: Path) -> None:
    generated = [
        "ws/build/x",
        "ws/install/lib/x",
        "ws/log/x",
        "ws/src/my_robot_package/__pycache__/x.pyc",
        ".git/config",
    ]
    plain, full = (
        _write(tmp_path / "plain", TREE),
        _write(tmp_path / "full", {**TREE, **dict.fromkeys(generated, b"x")}),
    )
    (full / "ws" / "install" / "link").symlink_to("/etc/passwd")
    assert read_submission(full, CHAPTER) == read_submission(plain, CHAPTER)
    assert read_submission(
        _zip(tmp_path / "f.zip", {**TREE, **dict.fromkeys(generated, b"x")}), CHAPTER
    ) == read_submission(plain, CHAPTER)


def test_files_that_macos_adds_to_archives_are_ignored(tmp_path: Path) -> None:
    files = {**TREE, "__MACOSX/ws/src/my_robot_package/._setup.py": b"\0\0"}
    assert _names(read_submission(_zip(tmp_path / "a.zip", files), CHAPTER).extra) == {"notes.txt"}


def test_an_empty_folder_and_a_folder_of_other_things_contain_nothing_to_grade(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    for folder in (tmp_path / "empty", _write(tmp_path / "essay", {"essay.pdf": b"%PDF"})):
        kind, sentence = _refusal(folder)
        assert kind is Kind.NOTHING_SUBMITTED
        assert "neither 02_nodes.ipynb nor a ws/src folder" in sentence


def test_a_missing_path_is_a_usage_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="nobody: there is no such file or folder"):
        read_submission(tmp_path / "nobody", CHAPTER)


def test_executable_files_stay_executable(tmp_path: Path) -> None:
    root = _write(tmp_path / "bob", {"src/pkg/run": b"#!/bin/sh", "src/pkg/data": b""})
    (root / "src/pkg/run").chmod(0o755)
    write_tree(read_submission(root, CHAPTER).source, tmp_path / "out")
    assert [os.access(tmp_path / "out/pkg" / name, os.X_OK) for name in ("run", "data")] == [True, False]


def test_the_digest_depends_on_paths_and_contents_but_not_on_the_packing(tmp_path: Path) -> None:
    folder = read_submission(_write(tmp_path / "a", TREE), CHAPTER).sha256
    assert read_submission(_zip(tmp_path / "a.zip", TREE), CHAPTER).sha256 == folder
    assert read_submission(_write(tmp_path / "b", {**TREE, "notes.txt": b"yours"}), CHAPTER).sha256 != folder


def test_windows_line_ends_spaces_and_unicode_are_kept(tmp_path: Path) -> None:
    files = {"src/mein Paket/größe 漢字.py": b"a = 1\r\n"}
    submission = read_submission(_zip(tmp_path / "a.zip", files), CHAPTER)
    write_tree(submission.source, tmp_path / "out")
    assert (tmp_path / "out/mein Paket/größe 漢字.py").read_bytes() == b"a = 1\r\n"


def test_a_name_that_is_not_utf_8_is_kept(tmp_path: Path) -> None:
    name = os.fsdecode(b"caf\xe9.txt")
    root = _write(tmp_path / "bob", {f"src/pkg/{name}": b"x"})
    write_tree(read_submission(root, CHAPTER).source, tmp_path / "out")
    assert (tmp_path / "out/pkg" / name).read_bytes() == b"x"


# Refused submissions.


@pytest.mark.parametrize(
    "name", ["../evil", "ws/../../evil", "/etc/cron.d/evil", "..\\evil", "C:\\evil", "\\\\host\\evil"]
)
def test_an_archive_that_points_outside_is_not_opened(tmp_path: Path, name: str) -> None:
    kind, sentence = _refusal(_zip(tmp_path / "a.zip", {**TREE, name: b"x"}))
    assert kind is Kind.UNSAFE_ARCHIVE
    assert "points outside the archive" in sentence


def _special(path: Path, mode: int) -> Path:
    info = zipfile.ZipInfo("ws/src/pkg/odd")
    info.external_attr = mode << 16
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(info, "/etc/passwd")
    return path


@pytest.mark.parametrize("kind", [stat.S_IFLNK, stat.S_IFIFO, stat.S_IFCHR, stat.S_IFBLK, stat.S_IFSOCK])
def test_links_pipes_and_devices_in_an_archive_are_refused(tmp_path: Path, kind: int) -> None:
    refused_kind, sentence = _refusal(_special(tmp_path / "a.zip", kind | 0o777))
    assert refused_kind is Kind.UNSAFE_ARCHIVE
    assert "ws/src/pkg/odd is not a regular file" in sentence


@pytest.mark.parametrize(
    ("make", "problem"),
    [
        (lambda path: path.symlink_to("/etc/passwd"), "a symbolic link"),
        (lambda path: path.symlink_to("/", target_is_directory=True), "a symbolic link"),
        (lambda path: path.symlink_to(path), "a symbolic link"),
        (os.mkfifo, "not a regular file"),
    ],
)
def test_links_and_pipes_in_a_folder_are_refused(tmp_path: Path, make: Callable[[Path], None], problem: str) -> None:
    make(_write(tmp_path / "bob", TREE) / "ws/src/odd")
    kind, sentence = _refusal(tmp_path / "bob")
    assert kind is Kind.UNSAFE_ARCHIVE
    assert f"ws/src/odd is {problem}" in sentence
    assert "without links" in sentence


def test_too_many_files_deep_folders_and_long_paths_are_rejected(tmp_path: Path) -> None:
    many = {f"src/pkg/{n}": b"" for n in range(intake.MAX_FILES + 1)}
    deep = {"src/" + "d/" * intake.MAX_DEPTH + "x": b""}
    long = {"src/" + "漢" * (intake.MAX_PATH_BYTES // 3): b""}  # 3 bytes each
    for files, reason in (
        (many, "more than 2000 files"),
        (deep, "nested more than 16 deep"),
        (long, "longer than 200"),
    ):
        kind, sentence = _refusal(_zip(tmp_path / "a.zip", files))
        assert kind is Kind.UNSAFE_ARCHIVE
        assert reason in sentence
    assert "more than 2000 files" in _refusal(_write(tmp_path / "many", many))[1]
    assert "nested more than 16 deep" in _refusal(_write(tmp_path / "deep", deep))[1]


def test_folders_nested_without_a_file_are_refused_too(tmp_path: Path) -> None:
    (tmp_path / "bob" / Path(*["d"] * 40)).mkdir(parents=True)
    assert "nested more than 16 deep" in _refusal(tmp_path / "bob")[1]


def _nest(folder: Path, names: list[str]) -> None:
    """Make nested folders whose path is too long for any system call."""
    opened = [os.open(folder, os.O_RDONLY)]
    for name in names:
        os.mkdir(name, dir_fd=opened[-1])
        opened.append(os.open(name, os.O_RDONLY, dir_fd=opened[-1]))
    for descriptor in opened:
        os.close(descriptor)


@pytest.mark.parametrize("is_copied", [False, True], ids=["as it is", "as root copies it for another user"])
def test_a_path_that_is_too_long_to_open_is_left_out_and_named(tmp_path: Path, is_copied: bool) -> None:
    def submitted_path(root: Path) -> Path:
        if is_copied:
            copy_submission(root, root.parent / f"{root.name} copied")
        return root.parent / f"{root.name} copied" if is_copied else root

    beside = _write(tmp_path / "bob", TREE)
    _nest(beside, ["n" * 255] * 15 + ["m" * 255] * 2)
    assert any(
        "longer than this system can open" in name for name in read_submission(submitted_path(beside), CHAPTER).unused
    )


def test_a_file_that_is_too_large_is_never_read(tmp_path: Path) -> None:
    root = _write(tmp_path / "bob", TREE)
    with (root / "ws/src/huge").open("wb") as stream:
        stream.truncate(intake.MAX_FILE_BYTES + 1)  # sparse: no byte of it is on the disk
    assert "ws/src/huge is larger than 16 MiB" in _refusal(root)[1]


def test_files_that_are_too_large_together_are_refused(tmp_path: Path) -> None:
    root = _write(tmp_path / "bob", TREE)
    for number in range(5):
        with (root / f"ws/src/{number}").open("wb") as stream:
            stream.truncate(intake.MAX_FILE_BYTES)
    assert "larger than 64 MiB in all" in _refusal(root)[1]


def test_a_zip_bomb_is_refused_by_the_size_that_it_states(tmp_path: Path) -> None:
    bomb = _zip(tmp_path / "a.zip", {"ws/src/bomb": b"\0" * (intake.MAX_FILE_BYTES + 1)})
    assert bomb.stat().st_size < 100_000
    assert "ws/src/bomb is larger than 16 MiB" in _refusal(bomb)[1]


def test_a_zip_with_a_wrong_size_is_unreadable(tmp_path: Path) -> None:
    data = bytearray(_zip(tmp_path / "a.zip", {"src/x": b"\0" * 100_000}).read_bytes())
    offset = data.rindex(b"PK\x01\x02") + 24
    assert struct.unpack("<I", data[offset : offset + 4]) == (100_000,)
    data[offset : offset + 4] = struct.pack("<I", 10)
    (tmp_path / "lie.zip").write_bytes(data)
    kind, sentence = _refusal(tmp_path / "lie.zip")
    assert kind is Kind.UNREADABLE
    assert "hand in one of these" in sentence


def test_damaged_bytes_are_unreadable_and_named(tmp_path: Path) -> None:
    intact = _zip(tmp_path / "a.zip", {"src/x": os.urandom(500) + b"text " * 900}).read_bytes()
    flipped, cut = intact[:60] + bytes(byte ^ 0xFF for byte in intact[60:90]) + intact[90:], intact[:200]
    for name, data in {"flipped.zip": flipped, "cut.zip": cut, "essay.pdf": b"%PDF-1.7", "empty.zip": b""}.items():
        (tmp_path / name).write_bytes(data)
        kind, sentence = _refusal(tmp_path / name)
        assert kind is Kind.UNREADABLE
        assert f"{name} is not a folder, a notebook or a readable zip or tar archive" in sentence


def test_an_encrypted_archive_is_unreadable(tmp_path: Path) -> None:
    data = bytearray(_zip(tmp_path / "a.zip", {"src/x": b"secret"}).read_bytes())
    for header, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        data[data.index(header) + flags] |= 1
    (tmp_path / "locked.zip").write_bytes(data)
    kind, sentence = _refusal(tmp_path / "locked.zip")
    assert kind is Kind.UNREADABLE
    assert "password" in sentence


def _tar(path: Path, *infos: tarfile.TarInfo, mode: Any = "w:gz") -> Path:
    with tarfile.open(path, mode) as archive:
        for info in infos:
            archive.addfile(info, io.BytesIO(bytes(info.size)) if info.isreg() else None)
    return path


def _member(name: str, kind: bytes = tarfile.REGTYPE, size: int = 0) -> tarfile.TarInfo:
    info = tarfile.TarInfo(name)
    info.type, info.size, info.linkname = kind, size, "/etc/passwd"
    return info


@pytest.mark.parametrize("name", ["../evil", "/etc/cron.d/evil", "ws/../../evil"])
def test_a_tar_that_points_outside_is_not_opened(tmp_path: Path, name: str) -> None:
    assert "points outside the archive" in _refusal(_tar(tmp_path / "a.tgz", _member("src/p/x"), _member(name)))[1]


@pytest.mark.parametrize("kind", [tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.CHRTYPE, tarfile.FIFOTYPE])
def test_links_pipes_and_devices_in_a_tar_are_refused(tmp_path: Path, kind: bytes) -> None:
    refused_kind, sentence = _refusal(
        _tar(tmp_path / "a.tar", _member("src/p/x"), _member("src/p/odd", kind), mode="w")
    )
    assert refused_kind is Kind.UNSAFE_ARCHIVE
    assert "src/p/odd is" in sentence


@pytest.mark.parametrize("mode", ["w:gz", "w:bz2", "w:xz"])
def test_a_tar_that_unpacks_to_too_much_is_not_read_to_its_end(
    tmp_path: Path, mode: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compression, "MAX_READ_BYTES", 2**21)
    bomb = _tar(tmp_path / "a.tar", _member("src/p/x"), _member("beside", size=2**22), mode=mode)
    assert bomb.stat().st_size < 20_000
    assert "it is larger than 2 MiB when it is unpacked" in _refusal(bomb)[1]


def test_a_truncated_tar_is_unreadable(tmp_path: Path) -> None:
    for mode in ("w:gz", "w:bz2", "w:xz"):
        intact = _tar(tmp_path / "a.tar", _member("src/p/x", size=9000), mode=mode).read_bytes()
        (tmp_path / "cut.tar.gz").write_bytes(intact[: len(intact) // 2])
        assert _refusal(tmp_path / "cut.tar.gz")[0] is Kind.UNREADABLE


def test_xz_that_asks_for_too_much_memory_is_unreadable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compression, "MAX_DICTIONARY", 2**20)
    assert _refusal(_tar(tmp_path / "a.tar.xz", _member("src/p/x"), mode="w:xz"))[0] is Kind.UNREADABLE


def test_endlessly_nested_archives_and_too_many_archives_are_not_opened(tmp_path: Path) -> None:
    data = _zip(tmp_path / "0.zip", TREE).read_bytes()
    for number in range(reading.MAX_NESTING + 2):
        data = _zip(tmp_path / "n.zip", {f"{number}.zip": data}).read_bytes()
    assert "is nested in 3 or more archives: hand in the folder as one zip" in _refusal(tmp_path / "n.zip")[1]
    empty = _zip(tmp_path / "e.zip", {}).read_bytes()
    many = _zip(tmp_path / "many.zip", {f"{number}.zip": empty for number in range(reading.MAX_ARCHIVES + 1)})
    assert "is one of more than 20 archives" in _refusal(many)[1]


def test_a_zip_with_an_endless_list_of_files_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zip_directory, "MAX_DIRECTORY", 100)
    assert "it holds too many files" in _refusal(_zip(tmp_path / "a.zip", TREE))[1]


def test_outputs_are_dropped_only_if_the_notebook_parses_to_few_values() -> None:
    notebook = b'{"nbformat": 4, "cells": [{"cell_type": "code", "source": "", "outputs": [%s]}]}'
    assert b"outputs" not in without_outputs(notebook % b'{"text": "\\"x"}')
    for outputs in (b"[]," * 3_000_000 + b"[]", b'"a",' * 1_000_001 + b'""', b"[" * 9_000_000):
        assert without_outputs(notebook % outputs) == notebook % outputs


def test_two_files_of_one_name_or_a_file_that_is_a_folder_are_refused(tmp_path: Path) -> None:
    twice = tmp_path / "twice.zip"
    twice.write_bytes(_zip(tmp_path / "a.zip", {"src/x": b"1", "src/y": b"2"}).read_bytes().replace(b"src/y", b"src/x"))
    for path in (twice, _zip(tmp_path / "both.zip", {"src/x": b"", "src/x/y": b""})):
        kind, sentence = _refusal(path)
        assert kind is Kind.UNSAFE_ARCHIVE
        assert "two of its files or folders have the same path" in sentence


@pytest.mark.fuzz
@given(st.binary(max_size=400))
def test_any_bytes_are_read_or_refused(tmp_path_factory: pytest.TempPathFactory, noise: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "noise.zip"
    path.write_bytes(noise)
    assert _refusal(path)[0] in (Kind.UNREADABLE, Kind.NOTHING_SUBMITTED)


@pytest.mark.fuzz
@given(st.lists(st.tuples(st.text("abws/rc.", min_size=1, max_size=12), st.binary(max_size=3)), max_size=6))
def test_files_of_any_names_are_written_below_the_folder_or_the_archive_is_refused(
    tmp_path_factory: pytest.TempPathFactory, files: list[tuple[str, bytes]]
) -> None:
    root = tmp_path_factory.mktemp("names")
    try:
        submission = read_submission(_zip(root / "a.zip", dict(files)), CHAPTER)
    except StudentError as error:
        event(error.diagnosis.kind.value)
        return
    write_tree(submission.source, root / "out" / "source")
    assert {path.name for path in root.iterdir()} <= {"a.zip", "out"}
    assert {path.name for path in (root / "out").iterdir()} == {"source"}


def test_an_answer_is_preferred_to_one_in_a_folder_below_it() -> None:
    old, new = (
        NOTEBOOK.replace(
            b"[]",
            b'[{"cell_type": "code", "source": "%%writefile ws/src/my_robot_package/my_robot_package/nodes/'
            b"robot_controller.py\\n" + text + b'"}]',
        )
        for text in (b"old", b"new")
    )
    entries = [
        SubmittedFile(PurePosixPath(f"a/old/{CHAPTER}.ipynb"), old),
        SubmittedFile(PurePosixPath(f"a/{CHAPTER}.ipynb"), new),
    ]
    layout = detect_layout(entries, CHAPTER)
    assert layout.notebook == new
    assert layout.unused == (f"a/old/{CHAPTER}.ipynb",)


# Files that a notebook leaves behind.


def test_the_packages_that_a_notebook_wrote_are_taken_as_plain_files(tmp_path: Path) -> None:
    assert _names(read_packages(_write(tmp_path, TREE) / "ws")) == SOURCE


@pytest.mark.parametrize("link", ["ws", "ws/src", "ws/src/pkg", "ws/src/my_robot_package/passwd"])
def test_a_link_that_a_notebook_left_is_never_followed(tmp_path: Path, link: str) -> None:
    root = _write(tmp_path / "run", TREE)
    if (root / link).exists():
        (root / link).rename(root / "moved")
    (root / link).symlink_to("/etc")
    with pytest.raises(StudentError) as excinfo:
        read_packages(root / "ws")
    assert excinfo.value.diagnosis.kind in (Kind.UNSAFE_ARCHIVE, Kind.NOTHING_SUBMITTED)


def test_a_notebook_that_writes_no_workspace_is_reported(tmp_path: Path) -> None:
    with pytest.raises(StudentError, match="After the notebook has run, there is no folder ws/src"):
        read_packages(tmp_path / "ws")
