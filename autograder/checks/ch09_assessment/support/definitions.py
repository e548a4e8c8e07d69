"""Compares the text of the student's message definitions with the contract."""

from __future__ import annotations

from pathlib import Path

from autograder.checking import CheckFailed, Workspace, expect
from autograder.checking.probes import interfaces
from autograder.checks.ch09_assessment.support.contract import INTERFACES, MESSAGES
from autograder.checks.ch09_assessment.support.robot import source_of


def expect_definitions(workspace: Workspace) -> None:
    """Fail the check unless both messages follow the contract; correct fields earn part of the points."""
    folder = source_of(workspace, INTERFACES)
    sentences, shares = [], []
    for path, text in MESSAGES.items():
        expected = interfaces.parse(INTERFACES, path, text)
        try:
            actual = interfaces.parse(INTERFACES, path, _definition_text(folder, path))
        except interfaces.Unreadable as error:
            raise CheckFailed(str(error)) from None
        differences = (*interfaces.compare(expected, actual), *_empty_defaults(path, actual))
        sentences += [difference.sentence for difference in differences]
        shares.append(interfaces.share(expected, differences))
    expect(not sentences, " ".join(sentences[:3]), fraction=round(0.5 * sum(shares) / len(shares), 2))


def _empty_defaults(path: str, interface: interfaces.Interface) -> list[interfaces.Difference]:
    """Return defaults that change no value. `compare` accepts them, but the contract does not allow defaults."""
    fields = [
        field for part in interface.parts for field in part.fields if field.default is not None and not field.default
    ]
    return [
        interfaces.Difference(
            interfaces.Aspect.DEFAULTS, f"{path}: {field.name} has the default {field.default!r}. It should have none."
        )
        for field in fields
    ]


def _definition_text(folder: Path, path: str) -> str:
    file = folder / path
    if file.is_symlink() or not file.is_file():
        names = sorted(str(other.relative_to(folder)) for other in folder.glob("msg/*.msg"))
        raise CheckFailed(f"{INTERFACES} has no {path}. Its messages: {', '.join(names) or 'none'}.")
    text = file.read_bytes()[: interfaces.MAX_BYTES + 1].decode(errors="replace")
    expect(
        "NotImplementedError" not in text,
        f"{path} is still to be written: replace the line raise NotImplementedError(...) with your fields.",
    )
    return text
