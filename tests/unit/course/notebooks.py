"""Small notebooks for the tests of the course tool."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from autograder.author.course.sync import Chapter

KERNEL = {"name": "python3", "display_name": "Python 3 (ipykernel)", "language": "python"}


def code(source: str, cell_id: str, **metadata: Any) -> NotebookNode:
    return new_code_cell(source, id=cell_id, metadata=metadata)


def prose(source: str, cell_id: str, **metadata: Any) -> NotebookNode:
    return new_markdown_cell(source, id=cell_id, metadata=metadata)


def solution(grade_id: str) -> dict[str, Any]:
    return {"grade": False, "grade_id": grade_id, "locked": False, "schema_version": 3, "solution": True, "task": False}


def grade(grade_id: str, points: float) -> dict[str, Any]:
    return {
        "grade": True,
        "grade_id": grade_id,
        "locked": True,
        "points": points,
        "schema_version": 3,
        "solution": False,
        "task": False,
    }


def manual(grade_id: str, points: float) -> dict[str, Any]:
    return {**grade(grade_id, points), "locked": False, "solution": True}


def notebook(*cells: NotebookNode, **course: Any) -> NotebookNode:
    return new_notebook(cells=list(cells), metadata={"kernelspec": KERNEL, "course": course})


def chapter(root: Path, content: NotebookNode, name: str = "01_small") -> Chapter:
    folder = root / "chapters" / name
    folder.mkdir(parents=True)
    saved = Chapter(folder)
    saved.write(content)
    return saved
