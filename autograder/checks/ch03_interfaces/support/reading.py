"""The student's definitions, read from the sources, and assertions on them."""

from __future__ import annotations

from autograder.checking import CheckFailed, Workspace, expect, find_packages
from autograder.checking.probes import interfaces
from autograder.checks.ch03_interfaces.support.contract import INTERFACES

STUB = "YOUR CODE HERE"  # marks the missing answer in a released cell


def expect_definition(workspace: Workspace, expected: interfaces.Interface, *aspects: interfaces.Aspect) -> None:
    """Fail the check unless a definition agrees with the contract in these aspects; parts that agree earn points."""
    differences = [
        difference
        for difference in interfaces.compare(expected, read_definition(workspace, expected))
        if difference.aspect in aspects
    ]
    sentences = " ".join(difference.sentence for difference in differences[:3])
    expect(not differences, sentences, fraction=_fraction(interfaces.share(expected, differences)))


def read_definition(workspace: Workspace, expected: interfaces.Interface) -> interfaces.Interface:
    """Return the student's version of a definition; fail the check if it is missing or cannot be read."""
    packages, _ = find_packages(workspace.root / "src")
    folder = packages.get(INTERFACES, workspace.root / "src" / INTERFACES)
    path = folder / expected.path
    if path.is_symlink() or not path.is_file():
        present_paths = [
            f"{file.parent.name}/{file.name}" for file in sorted(folder.glob("*/*")) if file.parent.name != "src"
        ]
        similar = interfaces.closest(expected.path, present_paths)
        suffix = f", but there is a {similar}" if similar else ""
        raise CheckFailed(f"There is no {INTERFACES}/{expected.path}{suffix}.")
    try:
        text = path.read_bytes()[: interfaces.MAX_BYTES + 1].decode()
        expect(STUB not in text, f"{expected.path} is still to be written.")
        return interfaces.parse(INTERFACES, expected.path, text)
    except UnicodeDecodeError:
        raise CheckFailed(f"{expected.path} is not UTF-8 text.") from None
    except interfaces.Unreadable as error:
        raise CheckFailed(str(error)) from None


def _fraction(share: float) -> float:
    """Return at most half of the points: other programs cannot use a definition that differs from the contract."""
    return round(share / 2, 2)
