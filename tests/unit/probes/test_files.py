"""A file of untrusted code is read only if it is a plain, small file."""

from __future__ import annotations

import ast
import os
from pathlib import Path

import pytest

from autograder.probes.files import parse_python, read_below, read_plain


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


def test_python_is_parsed_and_anything_else_is_not() -> None:
    assert isinstance(parse_python('import a\nb = "\\d"\n'), ast.Module)
    assert parse_python("def") is None
    assert parse_python(b"\0") is None
