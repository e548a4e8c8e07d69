"""`autograder new chapter` lists what it writes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from autograder import course_paths
from autograder.author.course.new import write_course


def test_a_new_chapter_lists_its_folders_and_the_syllabus_that_it_changed(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    write_course(folder)
    before = (folder / "syllabus.yaml").read_text()
    command = [sys.executable, "-m", "autograder", "--course", str(folder), "new", "chapter", "10_mapping"]
    completed = subprocess.run(command, cwd=course_paths.ROOT, text=True, capture_output=True)
    assert completed.returncode == 0, completed.stderr
    names = ("chapters/10_mapping", "checks/ch10_mapping", "solutions/mapping", "syllabus.yaml")
    assert completed.stdout.splitlines()[:5] == [*(str(folder / name) for name in names), ""]
    assert (folder / "syllabus.yaml").read_text() != before
