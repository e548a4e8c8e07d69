"""Files that came with a package are compared with those that a student handed in."""

from __future__ import annotations

from autograder.probes.given_files import changed_files, strip_licence

GIVEN = {"lamp/lamp.py": b"a = 1\n", "launch/lamp.py": b"b = 2\n", "setup.py": b"c = 3\n"}
FOLDERS = ("lamp", "launch")


def test_missing_and_changed_files_below_the_folders_are_named() -> None:
    assert changed_files({"lamp/lamp.py": b"a = 2\n"}, GIVEN, FOLDERS) == ["lamp/lamp.py", "launch/lamp.py"]


def test_changes_of_white_space_further_files_and_files_elsewhere_are_allowed() -> None:
    allowed = {"lamp/lamp.py": b"a  =  1", "launch/lamp.py": b"b = 2\n", "lamp/more.py": b"", "setup.py": b"d = 4\n"}
    assert changed_files(allowed, GIVEN, FOLDERS) == []


def test_a_file_may_lack_the_copyright_comment_as_in_the_notebook() -> None:
    licence = b"# Copyright 2026 Somebody\n#\n# Licensed under ...\n\n"
    originals = {"lamp/lamp.py": licence + b"a = 1\n"}
    assert changed_files({"lamp/lamp.py": b"a = 1\n"}, originals, FOLDERS) == []
    assert changed_files({"lamp/lamp.py": b"# coding: utf-7\na = 1\n"}, originals, FOLDERS) == ["lamp/lamp.py"]


def test_a_comment_that_is_not_a_licence_is_kept() -> None:
    assert strip_licence("# Why this is here.\nx = 1\n") == "# Why this is here.\nx = 1\n"
