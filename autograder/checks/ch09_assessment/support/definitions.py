"""The student's message definitions against the contract, by their text."""

from __future__ import annotations

from pathlib import Path

from autograder.checking import CheckFailed, Workspace, expect
from autograder.checking.probes import interfaces
from autograder.checks.ch09_assessment.support.contract import INTERFACES, MESSAGES
from autograder.checks.ch09_assessment.support.robot import source_of


def expect_definitions(workspace: Workspace) -> None:
    """Fail the check unless both messages are as the contract says; part of the points for a part of the fields."""
    folder = source_of(workspace, INTERFACES)
    sentences, shares = [], []
    for path, text in MESSAGES.items():
        wanted = interfaces.parse(INTERFACES, path, text)
        try:
            found = interfaces.parse(INTERFACES, path, _text(folder, path))
        except interfaces.Unreadable as error:
            raise CheckFailed(str(error)) from None
        differences = (*interfaces.compare(wanted, found), *_empty_defaults(path, found))
        sentences += [difference.sentence for difference in differences]
        shares.append(interfaces.share(wanted, differences))
    expect(not sentences, " ".join(sentences[:3]), fraction=round(0.5 * sum(shares) / len(shares), 2))


def _empty_defaults(path: str, found: interfaces.Interface) -> list[interfaces.Difference]:
    """Return the defaults that change no value, which `compare` lets pass: the contract says "without defaults"."""
    fields = [field for part in found.parts for field in part.fields if field.default is not None and not field.default]
    return [
        interfaces.Difference(
            interfaces.Aspect.DEFAULTS, f"{path}: {field.name} has the default {field.default!r}, it should be none."
        )
        for field in fields
    ]


def _text(folder: Path, path: str) -> str:
    file = folder / path
    if file.is_symlink() or not file.is_file():
        there = sorted(str(other.relative_to(folder)) for other in folder.glob("msg/*.msg"))
        raise CheckFailed(f"{INTERFACES} has no {path}; it has {', '.join(there) or 'no message at all'}.")
    text = file.read_bytes()[: interfaces.MAX_BYTES + 1].decode(errors="replace")
    expect(
        "NotImplementedError" not in text,
        f"{path} is still to be written: replace the line raise NotImplementedError(...) with your fields.",
    )
    return text
