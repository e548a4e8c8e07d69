"""Mutants that nobody chose: operators laid on what the student writes, and a sample of what comes out."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import yaml

from autograder import layout
from autograder.checks import suites
from autograder.course import Chapter, is_solution, origin
from autograder.proof.operators import changes

SAMPLE = 20  # of an assignment's: enough to see what a suite overlooks, few enough for a coffee


@dataclass(frozen=True)
class Generated:
    """A mutant made by an operator.

    Attributes:
        id: module, function, operator and number, such as `robot_controller.control_loop.compare.1`.
        file: its path below `src`.
        text: the file's whole new text.
        reason: why it may survive, from the suite's `survivors.yaml`; empty for most.
    """

    id: str
    file: str
    text: str
    reason: str = ""


def generated(assignment: str, *, most: int = SAMPLE) -> list[Generated]:
    """Return a sample of an assignment's generated mutants, always the same one for the same reference."""
    path = suites.hidden(assignment).folder / "survivors.yaml"
    reasons: dict[str, str] = yaml.safe_load(path.read_text(encoding="utf-8")) if path.is_file() else {}
    found = list(_all(assignment, reasons))
    drawn = sorted(found, key=lambda made: hashlib.sha256(made.id.encode()).digest())[:most]
    return [made for made in found if made in drawn]


def _all(assignment: str, reasons: dict[str, str]) -> Iterator[Generated]:
    for file, functions in _written_by_students(assignment):
        text = (layout.SOLUTIONS / file).read_text(encoding="utf-8")
        module = file.rpartition("/")[2].removesuffix(".py")
        count: Counter[tuple[str, str]] = Counter()
        for change in changes(text, functions):
            count[change.function, change.operator] += 1
            name = f"{module}.{change.function}.{change.operator}.{count[change.function, change.operator]}"
            yield Generated(name, file, change.apply(text), reasons.get(name, ""))


def _written_by_students(assignment: str) -> Iterator[tuple[str, frozenset[str] | None]]:
    """Yield the Python files of the reference that students write, with the functions that they write of them."""
    packages = suites.hidden(assignment).packages
    for cell in Chapter(layout.chapter(assignment)).read().cells:
        source = origin(cell) if is_solution(cell) else None
        if source is None or source.source.suffix != ".py" or source.source.parts[0] not in packages:
            continue
        if source.source.name == "setup.py" or source.source.parts[1] in ("launch", "test"):
            continue
        yield str(source.source), frozenset(source.hide) - {"main"} if source.hide else None
