"""Reads the answers in `written_from_the_notebooks/`, by people who had read only the notebooks.

The YAML file of a chapter lists the answers. A right answer replaces files of the reference with those in its
folder, and removes others. A wrong answer is the reference with one mistake that violates one sentence of the notebook.
`keeps_marks` says why a wrong answer loses no points.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder.author.verification.mutants import write_reference
from autograder.suite import suites

FOLDER = Path(__file__).with_name("written_from_the_notebooks")
ASSIGNMENTS = sorted(path.stem for path in FOLDER.glob("*.yaml"))  # a new chapter has none yet


@dataclass(frozen=True)
class RightAnswer:
    """A right answer: the folder with its files, and the files of the reference that it does not have."""

    assignment: str
    name: str
    removes: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        """The folder with the files of the answer, each at its path in the workspace's `src`."""
        return FOLDER / self.assignment / self.name

    def write(self, target: Path) -> None:
        """Write the workspace to a folder."""
        write_reference(suites.hidden(self.assignment).sources, target)
        for file in self.removes:
            (target / "src" / file).unlink()
        shutil.copytree(self.folder, target / "src", dirs_exist_ok=True)


@dataclass(frozen=True)
class WrongAnswer:
    """A wrong answer: texts to replace in the reference's files, and the sentence that the answer then violates."""

    assignment: str
    name: str
    sentence: str
    edits: tuple[Mapping[str, str], ...]
    keeps_marks: str

    def write(self, target: Path) -> None:
        """Write the workspace to a folder. Each text to replace has to occur once."""
        write_reference(suites.hidden(self.assignment).sources, target)
        for edit in self.edits:
            file = target / edit["file"]
            text = file.read_text(encoding="utf-8")
            assert text.count(edit["find"]) == 1, f"{self.name}: {edit['find']!r} does not occur once in {file.name}"
            file.write_text(text.replace(edit["find"], edit["replace"]), encoding="utf-8")


def right_answers(assignment: str) -> list[RightAnswer]:
    """Return the right answers to an assignment."""
    return [
        RightAnswer(assignment, entry["name"], tuple(entry.get("removes", ()))) for entry in _read(assignment)["right"]
    ]


def wrong_answers(assignment: str) -> list[WrongAnswer]:
    """Return the wrong answers to an assignment."""
    return [
        WrongAnswer(assignment, entry["name"], entry["sentence"], tuple(entry["edits"]), entry.get("keeps_marks", ""))
        for entry in _read(assignment)["wrong"]
    ]


def _read(assignment: str) -> dict[str, Any]:
    entries: dict[str, Any] = yaml.safe_load((FOLDER / f"{assignment}.yaml").read_text(encoding="utf-8"))
    return entries
