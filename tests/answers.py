"""A correct answer to 02 as a student's folder, and the folders and archives in which it is handed in."""

from __future__ import annotations

import io
import json
import tarfile
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.author.course.release import write_released
from autograder.author.course.sync import Chapter

CHAPTER = "02_nodes"
BOOK = f"{CHAPTER}.ipynb"
TARGET = "ws/src/my_robot_package/my_robot_package/nodes/robot_controller.py"
Files = Mapping[str, bytes]


@dataclass(frozen=True)
class Answer:
    """The `files` of a student's folder, with a correct answer in its file and its cell, and those of the release."""

    files: dict[str, bytes]
    released: dict[str, bytes]

    @property
    def cells(self) -> dict[str, bytes]:
        """The folder of a student who edited the cell but never ran it."""
        return {**self.released, BOOK: self.files[BOOK]}

    @property
    def editor(self) -> dict[str, bytes]:
        """The folder of a student who edited the file, but never the cell."""
        return {**self.files, BOOK: self.released[BOOK]}

    def notebook(self, change: Callable[[dict[str, Any]], None]) -> bytes:
        """Return the notebook after `change` has modified it."""
        notebook = json.loads(self.files[BOOK])
        change(notebook)
        return json.dumps(notebook).encode()


def make_answer(scratch: Path) -> Answer:
    """Return the reference as a student's answer; `scratch` is an empty folder."""
    folder = scratch / CHAPTER
    write_released(Chapter(course_paths.chapter(CHAPTER)), folder)
    released = {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    text = (course_paths.SOLUTIONS / TARGET.removeprefix("ws/src/")).read_text()
    return Answer({**released, TARGET: text.encode(), BOOK: filled(released[BOOK], text)}, released)


def filled(notebook: bytes, text: str) -> bytes:
    """Return a notebook with `text` in the cell of the exercise."""
    nb = json.loads(notebook)
    for cell in nb["cells"]:
        if cell["metadata"].get("nbgrader", {}).get("grade_id") == "robot-controller":
            cell["source"] = f"%%writefile {TARGET}\n{text}".splitlines(keepends=True)
    return json.dumps(nb, indent=1).encode()


def write(folder: Path, files: Files) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return folder


def zipped(files: Files, prefix: str = "", **options: Any) -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", **options) as archive:
        for name, content in files.items():
            archive.writestr(prefix + name, content)
    return data.getvalue()


def tarred(files: Files, prefix: str = "", mode: Any = "w") -> bytes:
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode=mode) as archive:
        for name, content in files.items():
            info = tarfile.TarInfo(prefix + name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return data.getvalue()
