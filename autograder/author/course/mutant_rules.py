"""The rules for `mutants.yaml` and related files: each edit matches the reference, and each check has a mutant."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding
from autograder.author.course.schema_sentences import Place, meant
from autograder.author.course.yaml_files import YamlFile, read_yaml

MUTANTS, SURVIVORS, SNAPSHOT = "mutants.yaml", "survivors.yaml", "mutants.snapshot.yaml"


def read_or_raise(path: Path) -> Any:
    """Return the data of one of these files.

    Raises:
        CourseError: it is not YAML, or violates its schema. The message lists all problems, line by line.
    """
    read = read_yaml(path, str(path))
    if read.findings:
        raise CourseError("\n".join(map(str, read.findings)))
    return read.data


def broken_mutants(
    folder: Path, shown: str, checks: Collection[str] | None, sources: Collection[str]
) -> Iterator[Finding]:
    """Yield the problems in a chapter's mutant files.

    Args:
        folder: the folder of the chapter's checks.
        shown: the folder's path in findings.
        checks: the ids of the hidden checks; None if they are unknown.
        sources: the folders of the reference that form an answer; empty if they are unknown.
    """
    for name in (SURVIVORS, SNAPSHOT):
        if (folder / name).is_file():
            yield from read_yaml(folder / name, f"{shown}/{name}").findings
    file = _read_mutants(folder, shown)
    yield from file.findings
    seen: set[str] = set()
    for place, entry in _entries(file):
        if (id := str(entry.get("id"))) in seen:
            yield file.finding((*place, "id"), f"two mutants are called `{id}`")
        seen.add(id)
        check = str(entry.get("check"))
        if checks is not None and "check" in entry and check not in checks:
            yield file.finding((*place, "check"), f"the hidden suite has no check `{check}`: {meant(check, [*checks])}")
        yield from _edits(file, place, entry, sources)


def unproven_checks(folder: Path, shown: str, checks: Collection[str]) -> Iterator[Finding]:
    """Yield a finding for each hidden check without a mutant that was written for it or is recorded to fail it."""
    file = _read_mutants(folder, shown)
    entries = [entry for _, entry in _entries(file)]
    proven = {str(entry.get("check")) for entry in entries}
    if (folder / SNAPSHOT).is_file():
        snapshot = read_yaml(folder / SNAPSHOT, f"{shown}/{SNAPSHOT}")
        rows = {} if snapshot.findings else snapshot.data or {}
        proven |= {check for entry in entries for check in _recorded(rows.get(entry.get("id"), ()), checks)}
    for check in checks:
        if check not in proven:
            yield file.finding((), f"no mutant fails the check `{check}`: add one with an error that it finds")


def _read_mutants(folder: Path, shown: str) -> YamlFile:
    if (path := folder / MUTANTS).is_file():
        return read_yaml(path, f"{shown}/{MUTANTS}")
    missing = Finding(f"{shown}/{MUTANTS}", None, "is missing: it contains flawed versions of the reference", 1)
    return YamlFile(missing.file, None, {}, (missing,))


def _entries(file: YamlFile) -> Iterator[tuple[Place, dict[str, Any]]]:
    """Yield the place and the entry of each mutant in a file. The schema reports invalid entries."""
    listed = file.data.get("mutants") if isinstance(file.data, dict) else None
    for index, entry in enumerate(listed if isinstance(listed, list) else ()):
        if isinstance(entry, dict):
            yield ("mutants", str(index)), entry


def _recorded(row: Any, checks: Collection[str]) -> Collection[str]:
    """Return the failed checks in a row of the snapshot."""
    failed = row["fails"] if isinstance(row, dict) else row
    return checks if failed == "all" else failed


def _edits(file: YamlFile, place: Place, entry: dict[str, Any], sources: Collection[str]) -> Iterator[Finding]:
    """Yield the problems in the edits of a mutant. Each edit applies to the result of the previous ones."""
    texts: dict[str, str | None] = {}
    edits = entry.get("edits")
    for index, edit in enumerate(edits if isinstance(edits, list) else ()):
        if not isinstance(edit, dict):
            continue
        here = (*place, "edits", str(index))
        name = edit.get("file", file.data.get("file"))
        if not isinstance(name, str):
            yield file.finding(here, "says no `file`, and there is none for all mutants at the top of the file")
            continue
        at = (*here, "file") if "file" in edit else ("file",)
        path = course_paths.SOLUTIONS / name
        if sources and name.partition("/")[0] not in sources:
            yield file.finding(at, f"`{name}` is in no package of the suite: {meant(name, [*sources])}")
            continue
        if name not in texts:
            texts[name] = path.read_text(encoding="utf-8") if path.is_file() else None
        text, find, put = texts[name], edit.get("find"), edit.get("replace")
        if "write" in edit:
            texts[name] = str(edit["write"])
        elif text is None:
            yield file.finding(at, f"the reference has no file {course_paths.course().solutions}/{name}")
        elif isinstance(find, str) and isinstance(put, str):
            if text.count(find) != 1:
                times = f"{text.count(find)} times" if text.count(find) else "nowhere"
                yield file.finding((*here, "find"), f"{find!r} occurs {times} in {name}, and must occur once")
            elif find == put:
                yield file.finding((*here, "replace"), f"the edit puts {put!r} in the place of itself")
            texts[name] = text.replace(find, put)
