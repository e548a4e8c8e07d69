"""The student's definitions, read from the sources, and assertions on them."""

from __future__ import annotations

from autograder.checking import CheckFailed, Workspace, expect, find_packages
from autograder.checking.probes import interfaces
from autograder.checks.ch03_interfaces.support.contract import INTERFACES

STUB = "YOUR CODE HERE"  # what a released cell holds where the answer belongs


def expect_like(workspace: Workspace, wanted: interfaces.Interface, *aspects: interfaces.Aspect) -> None:
    """Fail the check unless a definition has what the contract says, in these aspects; points for what is right."""
    differences = [found for found in interfaces.compare(wanted, read(workspace, wanted)) if found.aspect in aspects]
    sentences = " ".join(difference.sentence for difference in differences[:3])
    expect(not differences, sentences, fraction=_fraction(interfaces.share(wanted, differences)))


def read(workspace: Workspace, wanted: interfaces.Interface) -> interfaces.Interface:
    """Return the student's definition of the contract's name; fail the check if there is none that can be read."""
    packages, _ = find_packages(workspace.root / "src")
    folder = packages.get(INTERFACES, workspace.root / "src" / INTERFACES)
    path = folder / wanted.path
    if path.is_symlink() or not path.is_file():
        present = [
            f"{file.parent.name}/{file.name}" for file in sorted(folder.glob("*/*")) if file.parent.name != "src"
        ]
        near = interfaces.closest(wanted.path, present)
        raise CheckFailed(f"There is no {INTERFACES}/{wanted.path}" + (f", but a {near}." if near else "."))
    try:
        text = path.read_bytes()[: interfaces.MAX_BYTES + 1].decode()
        expect(STUB not in text, f"{wanted.path} is still to be written.")
        return interfaces.parse(INTERFACES, wanted.path, text)
    except UnicodeDecodeError:
        raise CheckFailed(f"{wanted.path} is not UTF-8 text.") from None
    except interfaces.Unreadable as error:
        raise CheckFailed(str(error)) from None


def _fraction(right: float) -> float:
    """Half of the points at most for a definition that is not the contract's: other programs cannot use it."""
    return round(right / 2, 2)
