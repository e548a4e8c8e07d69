"""Mutants: the reference solution with one realistic student error each, to prove what the checks see.

A suite's `mutants.yaml` says how each is made from the reference and which checks it loses.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder import layout
from autograder.checks import suites
from autograder.diagnosis import Kind
from autograder.exceptions import GraderError


@dataclass(frozen=True)
class Edit:
    """One change of one file of the reference.

    Attributes:
        file: its path below `src`.
        find: a text that stands exactly once in the file, or None when the change is of the whole file.
        replace: what it becomes; None for a file that is deleted.
    """

    file: str
    find: str | None
    replace: str | None


@dataclass(frozen=True)
class Mutant:
    """A flawed version of the reference solution.

    Attributes:
        id: its name.
        title: the error in words.
        edits: how it is made.
        loses: ids of every check that does not pass.
        diagnosis: what the result says of bringing its node to life.
        demo: whether the demonstration grades it.
        slow: whether grading it waits for a time-out.
    """

    id: str
    title: str
    edits: tuple[Edit, ...]
    loses: frozenset[str]
    diagnosis: Kind = Kind.OK
    demo: bool = False
    slow: bool = False


def mutants(assignment: str) -> tuple[Mutant, ...]:
    """Return an assignment's mutants.

    Raises:
        GraderError: the file names a check that the suite does not have.
    """
    suite = suites.hidden(assignment)
    known = frozenset(check.id for check in suite.checks)
    data = yaml.safe_load((suite.folder / "mutants.yaml").read_text())
    return tuple(_mutant(entry, data["file"], known) for entry in data["mutants"])


def write_reference(sources: tuple[str, ...], folder: Path) -> None:
    """Copy packages and other folders of the reference solution to `folder`/src."""
    for source in sources:
        shutil.copytree(layout.SOLUTIONS / source, folder / "src" / source)


def write_mutant(mutant: Mutant, sources: tuple[str, ...], folder: Path) -> None:
    """Write a mutant as a source tree, `folder`/src.

    Raises:
        GraderError: an edit no longer fits the reference; the message names it.
    """
    write_reference(sources, folder)
    for edit in mutant.edits:
        _apply(mutant, edit, folder / "src" / edit.file)


def _apply(mutant: Mutant, edit: Edit, path: Path) -> None:
    if edit.replace is None:
        path.unlink()
        return
    if edit.find is None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(edit.replace)
        return
    text = path.read_text()
    if text.count(edit.find) != 1:
        raise GraderError(f"mutant {mutant.id}: {edit.find!r} stands {text.count(edit.find)} times in {edit.file}")
    path.write_text(text.replace(edit.find, edit.replace))


def _edit(entry: dict[str, Any], file: str) -> Edit:
    """Read `{find, replace}`, `{write: TEXT}` or `{delete: true}`, each with a `file` of its own if need be."""
    file = entry.get("file", file)
    if entry.get("delete"):
        return Edit(file, None, None)
    return Edit(file, None, entry["write"]) if "write" in entry else Edit(file, entry["find"], entry["replace"])


def _mutant(entry: dict[str, Any], file: str, known: frozenset[str]) -> Mutant:
    loses = known if entry["loses"] == "all" else frozenset(entry["loses"])
    if not loses <= known:
        raise GraderError(f"mutant {entry['id']}: there is no check {', '.join(sorted(loses - known))}")
    return Mutant(
        id=entry["id"],
        title=entry["title"],
        edits=tuple(_edit(edit, file) for edit in entry["edits"]),
        loses=loses,
        diagnosis=Kind(entry.get("diagnosis", "ok")),
        demo=entry.get("demo", False),
        slow=entry.get("slow", False),
    )
