"""Files that came with a package are compared with those that a student handed in."""

from __future__ import annotations

import pytest

from autograder.probes.given_files import MAX_BYTES, changed_files, strip_licence

GIVEN = {"lamp/lamp.py": b"a = 1\n", "launch/lamp.py": b"b = 2\n", "setup.py": b"c = 3\n"}
FOLDERS = ("lamp", "launch")


def test_missing_and_changed_files_below_the_folders_are_named() -> None:
    assert changed_files({"lamp/lamp.py": b"a = 2\n"}, GIVEN, FOLDERS) == ["lamp/lamp.py", "launch/lamp.py"]


def test_the_layout_further_files_and_files_elsewhere_are_allowed() -> None:
    allowed = {"lamp/lamp.py": b"a  =  1", "launch/lamp.py": b"b = 2\n", "lamp/more.py": b"", "setup.py": b"d = 4\n"}
    assert changed_files(allowed, GIVEN, FOLDERS) == []


def test_a_file_may_lack_the_copyright_comment_as_in_the_notebook() -> None:
    licence = b"# Copyright 2026 Somebody\n#\n# Licensed under ...\n\n"
    originals = {"lamp/lamp.py": licence + b"a = 1\n"}
    assert changed_files({"lamp/lamp.py": b"a = 1\n"}, originals, FOLDERS) == []
    hidden = b"# coding: utf-7\na = 1\n# +AAo-a = 2\n"
    assert changed_files({"lamp/lamp.py": hidden}, originals, FOLDERS) == ["lamp/lamp.py"]


def test_a_comment_that_is_not_a_licence_is_kept() -> None:
    assert strip_licence("# Why this is here.\nx = 1\n") == "# Why this is here.\nx = 1\n"


PYTHON = b"def test_all():\n    def near():\n        return 1\n    assert near() == 1\n"
YAML = b"# The lamp.\nlamp:\n  ros__parameters:\n    side: 1.0\n    lit: true\n"
LINES = b"one two\n  three\n"


@pytest.mark.parametrize(
    ("name", "given", "actual"),
    [
        ("a.py", PYTHON, PYTHON.replace(b"\n", b"\r\n")),
        ("a.py", PYTHON, PYTHON.replace(b"\n", b"  \n").rstrip()),
        ("a.py", PYTHON, b"\xef\xbb\xbf# Mine.\n" + PYTHON + b"\n\n"),
        ("a.yaml", YAML, YAML.replace(b"\n", b" \r\n").rstrip()),
        ("a.yaml", YAML, b"lamp: {ros__parameters: {lit: true, side: 1.0}}"),
        ("a.txt", LINES, b"one two \r\n  three"),
    ],
)
def test_a_file_with_the_same_meaning_is_unchanged(name: str, given: bytes, actual: bytes) -> None:
    assert changed_files({f"test/{name}": actual}, {f"test/{name}": given}, ("test",)) == []


@pytest.mark.parametrize(
    ("name", "given", "actual"),
    [
        ("a.py", PYTHON, PYTHON.replace(b"    assert", b"        assert")),  # after a return, where it never runs
        ("a.py", PYTHON, PYTHON.replace(b"== 1", b"== 1.0")),
        ("a.py", PYTHON, PYTHON + b"x = (\n"),
        ("a.py", PYTHON, PYTHON + b"\0"),
        ("a.py", PYTHON, PYTHON + b"#" * MAX_BYTES),
        ("a.py", PYTHON, PYTHON + b"x = " + b"-" * 100_000 + b"1\n"),
        ("a.yaml", YAML, YAML.replace(b"    side", b"side")),
        ("a.yaml", YAML, YAML.replace(b"1.0", b"1")),
        ("a.yaml", YAML, YAML.replace(b"true", b"1")),
        ("a.yaml", YAML, YAML + b"  - ["),
        ("a.yaml", YAML, b"lamp: {ros__parameters: {<<: {lit: true, side: 1.0}}}"),
        ("a.py", b"x = 1", b"x = 0x" + b"f" * 20_000),
        ("a.txt", LINES, b"one two\nthree\n"),
        ("a.txt", LINES, b"one two three\n"),
    ],
)
def test_a_file_with_another_meaning_is_changed(name: str, given: bytes, actual: bytes) -> None:
    assert changed_files({f"test/{name}": actual}, {f"test/{name}": given}, ("test",)) == [f"test/{name}"]
