"""Files that came with a package are compared with those that a student handed in."""

from __future__ import annotations

from autograder.probes.given_files import changed_files

GIVEN = {"lamp/lamp.py": b"a = 1\n", "launch/lamp.py": b"b = 2\n", "setup.py": b"c = 3\n"}
FOLDERS = ("lamp", "launch")


def test_missing_and_changed_files_below_the_folders_are_named() -> None:
    assert changed_files({"lamp/lamp.py": b"a = 2\n"}, GIVEN, FOLDERS) == ["lamp/lamp.py", "launch/lamp.py"]


def test_white_space_further_files_and_files_elsewhere_are_free() -> None:
    kept = {"lamp/lamp.py": b"a  =  1", "launch/lamp.py": b"b = 2\n", "lamp/more.py": b"", "setup.py": b"d = 4\n"}
    assert changed_files(kept, GIVEN, FOLDERS) == []
