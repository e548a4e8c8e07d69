"""A file of untrusted code is read only if it is a plain, small file."""

from __future__ import annotations

import ast
import os
from pathlib import Path

import pytest

from autograder.probes.files import parse_python, read_plain


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


def test_python_is_parsed_and_anything_else_is_not() -> None:
    assert isinstance(parse_python('import a\nb = "\\d"\n'), ast.Module)
    assert parse_python("def") is None
    assert parse_python(b"\0") is None
