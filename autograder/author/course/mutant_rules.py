"""The rules for `mutants.yaml` and related files: each edit matches the reference, and each check has a mutant."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from autograder import course_paths
from autograder.author.course.findings import Finding, display_path
from autograder.author.course.schema_sentences import KeyPath, suggestion
from autograder.author.course.yaml_files import YamlFile, read_yaml

MUTANTS, SURVIVORS, SNAPSHOT = "mutants.yaml", "survivors.yaml", "mutants.snapshot.yaml"


def mutants_findings(folder: Path, checks: Collection[str] | None, sources: Collection[str]) -> Iterator[Finding]:
    """Yield the problems in a chapter's mutant files.

    Args:
        folder: the folder of the chapter's checks.
        checks: the ids of the hidden checks; None if they are unknown.
        sources: the folders of the reference that form an answer; empty if they are unknown.
    """
    if (folder / SURVIVORS).is_file():
        yield from read_yaml(folder / SURVIVORS).findings
    file, snapshot = _read_mutants(folder), _read_snapshot(folder)
    yield from snapshot.findings
    yield from file.findings
    ids: set[str] = set()
    for path, entry in _entries(file):
        if (id := str(entry.get("id"))) in ids:
            yield file.finding((*path, "id"), f"two mutants are called `{id}`")
        ids.add(id)
        check = str(entry.get("check"))
        if checks is not None and "check" in entry and check not in checks:
            message = f"the hidden suite has no check `{check}`: {suggestion(check, checks)}"
            yield file.finding((*path, "check"), message)
        edits_findings, edited_texts = _apply_edits(file, path, entry, sources)
        yield from edits_findings
        # A mutant is meant not to be Python if a record says that its programs do not run, or if it gives a reason.
        if not (edits_findings or "reason" in entry or isinstance(snapshot.data.get(entry.get("id")), dict)):
            yield from _syntax_findings(file, edited_texts)


def unproven_checks(folder: Path, checks: Collection[str]) -> Iterator[Finding]:
    """Yield a finding for each hidden check if no mutant was written for it and none is recorded to fail it.

    If `mutants.yaml` cannot be read, another finding says so, and this function yields none.
    """
    file = _read_mutants(folder)
    if file.findings and file.data is None:
        return
    entries = [entry for _, entry in _entries(file)]
    rows = _read_snapshot(folder).data
    proven_checks = {str(entry.get("check")) for entry in entries}
    proven_checks |= {check for entry in entries for check in _recorded_failures(rows.get(entry.get("id"), ()), checks)}
    for check in checks:
        if check not in proven_checks:
            yield file.finding((), f"no mutant fails the check `{check}`: add one with an error that it finds")


def unknown_records(folder: Path) -> Iterator[Finding]:
    """Yield a finding for the records of mutants that `mutants.yaml` does not define, at the first of them.

    This is no reason to refuse a verification, which can remove the records.
    """
    mutants, snapshot = _read_mutants(folder), _read_snapshot(folder)
    ids = [str(entry.get("id")) for _, entry in _entries(mutants)]
    command = f"autograder verify --assignment {folder.name.removeprefix('ch')} --record"
    unknown = [str(name) for name in snapshot.data if name not in ids] if not mutants.findings else []
    if unknown:
        names = ", ".join(f"`{name}`" for name in unknown)
        records = "this record" if len(unknown) == 1 else "these records"
        message = f"{MUTANTS} has no mutant {names}: correct its `id` there, or remove {records} by `{command}`"
        yield snapshot.finding((unknown[0],), message)


def _read_snapshot(folder: Path) -> YamlFile:
    """Return a chapter's snapshot. Its data are the records by mutant, or empty if it is missing or invalid."""
    path = folder / SNAPSHOT
    file = read_yaml(path) if path.is_file() else YamlFile(display_path(path), None, {})
    return replace(file, data={} if file.findings else file.data or {})


def _read_mutants(folder: Path) -> YamlFile:
    if (path := folder / MUTANTS).is_file():
        return read_yaml(path)
    missing_file = Finding(display_path(path), None, "is missing: it contains flawed versions of the reference", 1)
    return YamlFile(missing_file.file, None, {}, (missing_file,))


def _entries(file: YamlFile) -> Iterator[tuple[KeyPath, dict[str, Any]]]:
    """Yield the key path and the entry of each mutant in a file. The schema reports invalid entries."""
    entries = file.data.get("mutants") if isinstance(file.data, dict) else None
    for index, entry in enumerate(entries if isinstance(entries, list) else ()):
        if isinstance(entry, dict):
            yield ("mutants", str(index)), entry


def _recorded_failures(row: Any, checks: Collection[str]) -> Collection[str]:
    """Return the failed checks in a row of the snapshot."""
    failed_checks = row["fails"] if isinstance(row, dict) else row
    return checks if failed_checks == "all" else failed_checks


def _apply_edits(
    file: YamlFile, path: KeyPath, entry: dict[str, Any], sources: Collection[str]
) -> tuple[list[Finding], dict[str, tuple[KeyPath, str]]]:
    """Apply the edits of a mutant, each to the result of the previous ones.

    Return the problems in them, and the new text of each edited file with the key path of its last edit.
    """
    findings: list[Finding] = []
    texts: dict[str, str | None] = {}
    edited_texts: dict[str, tuple[KeyPath, str]] = {}
    edits = entry.get("edits")
    for index, edit in enumerate(edits if isinstance(edits, list) else ()):
        if not isinstance(edit, dict):
            continue
        edit_path = (*path, "edits", str(index))
        name = edit.get("file", file.data.get("file"))
        if not isinstance(name, str):
            message = "has no `file`, and the top of mutants.yaml does not name a default one"
            findings.append(file.finding(edit_path, message))
            continue
        name_path = (*edit_path, "file") if "file" in edit else ("file",)
        source = course_paths.SOLUTIONS / name
        if sources and name.partition("/")[0] not in sources:
            message = f"`{name}` is not in a package of the suite: {suggestion(name, sources)}"
            findings.append(file.finding(name_path, message))
            continue
        if name not in texts:
            texts[name] = source.read_text(encoding="utf-8") if source.is_file() else None
        text, find, replacement = texts[name], edit.get("find"), edit.get("replace")
        if "write" in edit:
            texts[name] = new_text = str(edit["write"])
            edited_texts[name] = (*edit_path, "write"), new_text
        elif text is None:
            message = f"the reference has no file {course_paths.course().solutions}/{name}"
            findings.append(file.finding(name_path, message))
        elif isinstance(find, str) and isinstance(replacement, str):
            if text.count(find) != 1:
                times = f"{text.count(find)} times" if text.count(find) else "nowhere"
                message = f"{find!r} occurs {times} in {name}, and must occur once"
                findings.append(file.finding((*edit_path, "find"), message))
            elif find == replacement:
                message = f"the edit replaces {replacement!r} with itself"
                findings.append(file.finding((*edit_path, "replace"), message))
            texts[name] = new_text = text.replace(find, replacement)
            edited_texts[name] = (*edit_path, "replace"), new_text
        elif edit.get("delete"):
            edited_texts.pop(name, None)
    return findings, edited_texts


def _syntax_findings(file: YamlFile, edited_texts: Mapping[str, tuple[KeyPath, str]]) -> Iterator[Finding]:
    """Yield a finding for each edited Python file that cannot be parsed."""
    for name, (path, text) in edited_texts.items():
        try:
            ast.parse(text if name.endswith(".py") else "")
        except (SyntaxError, ValueError) as error:  # a null byte is a ValueError
            reason, line = getattr(error, "msg", error), getattr(error, "lineno", None) or 1
            message = (
                f"after this edit, {name} is not Python: {reason} in line {line}. Correct it, or, if students make"
            )
            yield file.finding(path, f"{message} this error, say in `reason` of the mutant that it is intended")
