"""Named mutants: copies of the reference solution, each with one realistic error of a student.

A suite's `mutants.yaml` defines the edits of each mutant and the check that it should fail. A snapshot beside that file
records all checks that the mutant fails, and its diagnosis (`autograder.author.verification.snapshot`).
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.author.course.yaml_files import load_yaml
from autograder.author.verification import snapshot
from autograder.author.verification.snapshot import Record
from autograder.diagnosis import Kind
from autograder.exceptions import GraderError
from autograder.suite import suites


@dataclass(frozen=True)
class Edit:
    """A change to one file of the reference.

    Attributes:
        file: path of the file, relative to `src`.
        find: the text to replace, which occurs exactly once in the file. None means the whole file.
        replace: the new text. None deletes the file.
    """

    file: str
    find: str | None
    replace: str | None


@dataclass(frozen=True)
class Mutant:
    """A flawed version of the reference solution.

    Attributes:
        id: unique in the assignment.
        title: a description of the error.
        edits: changes to the reference.
        check: id of the check for which the mutant was written.
        fails: the recorded ids of all checks that the mutant does not pass; empty if it has no record.
        diagnosis: the recorded diagnosis of how the programs were built and started.
        demo: whether `make demo` grades it.
        slow: whether grading it waits for a time-out.
        reason: why it costs much more than its own check, if its result does not explain it; see `costs`.
    """

    id: str
    title: str
    edits: tuple[Edit, ...]
    check: str
    fails: frozenset[str] = frozenset()
    diagnosis: Kind = Kind.OK
    demo: bool = False
    slow: bool = False
    reason: str = ""


def mutants(assignment: str) -> tuple[Mutant, ...]:
    """Return an assignment's mutants.

    Raises:
        CourseError: `mutants.yaml` is not YAML, or violates its schema.
        GraderError: `mutants.yaml` names a check that the suite does not have.
    """
    suite = suites.hidden(assignment)
    check_ids, records = frozenset(check.id for check in suite.checks), snapshot.recorded(assignment)
    data = load_yaml(suite.folder / "mutants.yaml")
    return tuple(_parse_mutant(entry, data.get("file", ""), check_ids, records) for entry in data["mutants"])


def write_reference(sources: tuple[str, ...], folder: Path) -> None:
    """Copy packages and other folders of the reference solution to `folder/src`."""
    for source in sources:
        shutil.copytree(course_paths.SOLUTIONS / source, folder / "src" / source)


def write_mutant(mutant: Mutant, sources: tuple[str, ...], folder: Path) -> None:
    """Write a mutant as a source tree, `folder/src`.

    Args:
        mutant: the mutant to write.
        sources: the names of the packages and folders of `solutions/` to copy.
        folder: the folder that gets `src`.

    Raises:
        GraderError: a text to replace does not occur exactly once in its file.
    """
    write_reference(sources, folder)
    for edit in mutant.edits:
        _apply_edit(mutant, edit, folder / "src" / edit.file)


def _apply_edit(mutant: Mutant, edit: Edit, path: Path) -> None:
    if edit.replace is None:
        path.unlink()
        return
    if edit.find is None:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(edit.replace)
        return
    text = path.read_text()
    if text.count(edit.find) != 1:
        problem = f"{edit.find!r} occurs {text.count(edit.find)} times in {edit.file}"
        raise GraderError(f"mutant {mutant.id}: {problem}: correct the edit in mutants.yaml")
    path.write_text(text.replace(edit.find, edit.replace))


def _parse_edit(entry: dict[str, Any], file: str) -> Edit:
    """Read `{find, replace}`, `{write: TEXT}` or `{delete: true}`. `file` is the file if the entry names none."""
    file = entry.get("file", file)
    if entry.get("delete"):
        return Edit(file, None, None)
    return Edit(file, None, entry["write"]) if "write" in entry else Edit(file, entry["find"], entry["replace"])


def _parse_mutant(entry: dict[str, Any], file: str, check_ids: frozenset[str], records: Mapping[str, Record]) -> Mutant:
    check = entry.get("check")
    if check not in check_ids:
        raise GraderError(
            f"mutant {entry['id']}: the suite has no check {check}: correct `check` of this mutant in mutants.yaml"
        )
    record = records.get(entry["id"], Record())
    return Mutant(
        id=entry["id"],
        title=entry["title"],
        edits=tuple(_parse_edit(edit, file) for edit in entry["edits"]),
        check=check,
        fails=record.fails,
        diagnosis=record.diagnosis,
        demo=entry.get("demo", False),
        slow=entry.get("slow", False),
        reason=entry.get("reason", ""),
    )
