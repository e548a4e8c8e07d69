"""A file of untrusted code is read only if it is a plain, small file."""

from __future__ import annotations

import ast
import errno
import os
from pathlib import Path

import pytest

from autograder.probes.files import parse_python, plain_files, read_below, read_limited, read_plain
from autograder.suite import CheckFailed


def test_a_plain_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    assert read_plain(path, 5) == b"12345"
    assert read_plain(path, 4) is None


@pytest.mark.parametrize("kind", ["missing", "folder", "link", "pipe"])
def test_folders_links_pipes_and_missing_files_are_not_read(kind: str, tmp_path: Path) -> None:
    path, target = tmp_path / "path", tmp_path / "target"
    target.write_text("secret")
    if kind == "folder":
        path.mkdir()
    elif kind == "link":
        path.symlink_to(target)
    elif kind == "pipe":
        os.mkfifo(path)
    assert read_plain(path, 100) is None


def test_a_file_behind_a_link_out_of_the_folder_or_in_a_circle_of_links_is_not_read(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    (folder / "inside").mkdir(parents=True)
    (folder / "inside" / "file").write_bytes(b"1")
    (tmp_path / "file").write_bytes(b"2")
    (folder / "out").symlink_to(tmp_path)
    (folder / "circle").symlink_to(folder / "circle")
    assert read_below(folder, Path("inside/file"), 5) == b"1"
    assert read_below(folder, Path("out/file"), 5) is None
    assert read_below(folder, Path("circle/file"), 5) is None


def test_a_file_that_is_too_large_to_search_is_refused_and_a_missing_one_is_empty(tmp_path: Path) -> None:
    path = tmp_path / "file"
    assert read_limited(path, 1024, "the file") == b""
    path.write_bytes(b"x" * 1024)
    assert len(read_limited(path, 1024, "the file")) == 1024
    path.write_bytes(b"x" * 1025)
    with pytest.raises(CheckFailed, match="the file is larger than 1 KiB"):
        read_limited(path, 1024, "the file")


def test_what_a_build_has_made_unreadable_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(path: Path, *arguments: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", str(path))

    monkeypatch.setattr(os, "open", refuse)  # root can read every file
    monkeypatch.setattr(os, "scandir", refuse)
    assert read_plain(tmp_path / "lamp.py", 5) is None
    with pytest.raises(CheckFailed, match=r"lamp\.py cannot be read: setup\.py must not change permissions"):
        read_limited(tmp_path / "lamp.py", 5, "lamp.py")
    with pytest.raises(CheckFailed, match=f"{tmp_path.name} cannot be read"):
        plain_files(tmp_path, 5)


def test_more_files_than_are_searched_are_refused_and_not_cut_off(tmp_path: Path) -> None:
    for name in "abc":
        (tmp_path / f"{name}.py").touch()
    assert len(plain_files(tmp_path, 3)) == 3
    with pytest.raises(CheckFailed, match="contains more than 2 files"):
        plain_files(tmp_path, 2)


def test_python_is_parsed_and_anything_else_is_not() -> None:
    assert isinstance(parse_python('import a\nb = "\\d"\n'), ast.Module)
    assert parse_python("def") is None
    assert parse_python(b"\0") is None
