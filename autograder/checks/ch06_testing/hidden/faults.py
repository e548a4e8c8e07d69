"""The versions of speed_guard on which a student's tests run: correct ones in two styles, and faulty ones in both."""

from __future__ import annotations

import random
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from autograder.checking import GraderError, solution_path
from autograder.checking.probes import versions
from autograder.checks.ch06_testing.support.contract import PACKAGE, SCRIPTS

STYLES = ("first", "second")
FOLDER = Path(__file__).parent / "versions"


@dataclass(frozen=True)
class Fault:
    """One way to break the contract.

    Attributes:
        id: the fault's id.
        check: the id of the check to which the fault belongs.
        file: the file that is changed.
        edits: by style, the text to find and its replacement.
        last: styles in which only the last match is replaced; in the other styles, there is only one match.
    """

    id: str
    check: str
    file: str
    edits: dict[str, tuple[str, str]]
    last: frozenset[str]


@cache
def faults() -> tuple[Fault, ...]:
    """Return every fault, in the order of the file."""
    return tuple(_fault(entry) for entry in yaml.safe_load((FOLDER / "faults.yaml").read_text()))


@cache
def version_in(style: str) -> versions.Version:
    """Return the correct version in this style."""
    first = versions.read(solution_path(PACKAGE), SCRIPTS)
    if style == STYLES[0]:
        return first
    return versions.Version({**first.files, **versions.read(FOLDER / style, SCRIPTS).files}, SCRIPTS)


def correct_version(style: str, draw: random.Random) -> versions.Version:
    """Return an obfuscated correct version in this style."""
    return versions.obfuscate(version_in(style), draw.getrandbits(32))


def reworded_version(draw: random.Random) -> versions.Version:
    """Return an obfuscated correct version in the first style, with one expression of each file rewritten."""
    drawn_edits = _harmless_edits()["drawn"]
    return _edited({name: [draw.choice(edits)] for name, edits in drawn_edits.items()}, "reworded", draw)


def minimal_version(draw: random.Random) -> versions.Version:
    """Return an obfuscated correct version in the first style whose safe_speed does no more than its contract requires.

    Its computed speeds have a rounding error, and its exception has no message.
    """
    return _edited(_harmless_edits()["bare"], "reduced to its contract", draw)


def _harmless_edits() -> dict[str, dict[str, list[dict[str, str]]]]:
    edits: dict[str, dict[str, list[dict[str, str]]]] = yaml.safe_load((FOLDER / "reworded.yaml").read_text())
    return edits


def _edited(edits: dict[str, list[dict[str, str]]], label: str, draw: random.Random) -> versions.Version:
    files = dict(version_in(STYLES[0]).files)
    for name, file_edits in edits.items():
        for edit in file_edits:
            files[name] = _edit(files[name], edit, f"{name}, {label}")
    return versions.obfuscate(versions.Version(files, SCRIPTS), draw.getrandbits(32))


def _edit(text: str, edit: dict[str, str], label: str) -> str:
    if text.count(edit["find"]) != 1:
        raise GraderError(f"{label}: {edit['find']!r} occurs {text.count(edit['find'])} times in the file")
    return text.replace(edit["find"], edit["replace"])


def faulty_version(fault: Fault, style: str, draw: random.Random) -> versions.Version:
    """Return an obfuscated faulty version in this style.

    Raises:
        GraderError: the fault no longer fits the style's text.
    """
    version, (find, replace) = version_in(style), fault.edits[style]
    text = version.files[fault.file]
    count = text.count(find)
    if count == 0 or (count > 1 and style not in fault.last):
        raise GraderError(f"fault {fault.id}: {find!r} occurs {count} times in {fault.file} of style {style}")
    head, _, tail = text.rpartition(find)
    files = {**version.files, fault.file: head + replace + tail}
    return versions.obfuscate(versions.Version(files, version.scripts), draw.getrandbits(32))


def _fault(entry: dict[str, Any]) -> Fault:
    edits = {style: (entry[style]["find"], entry[style]["replace"]) for style in STYLES}
    last = frozenset(style for style in STYLES if entry[style].get("last"))
    return Fault(entry["id"], entry["check"], entry["file"], edits, last)
