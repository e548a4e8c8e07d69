"""Generates mutants: applies the operators to the code that students write, and draws a sample."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import yaml

from autograder import layout
from autograder.checks import suites
from autograder.course.cells import is_solution, origin
from autograder.course.sync import Chapter
from autograder.proof.operators import changes

SAMPLE_SIZE = 20  # mutants of an assignment; a larger sample finds hardly more, and takes longer to grade


@dataclass(frozen=True)
class GeneratedMutant:
    """A mutant that an operator made.

    Attributes:
        id: module, function, operator and number, such as `wheel_node.turn.compare.1`.
        file: path of the changed file, below `src`.
        text: whole new text of the file.
        reason: the reason why it may survive, from `survivors.yaml` of the suite. It is empty for most mutants.
    """

    id: str
    file: str
    text: str
    reason: str = ""


def generated_mutants(assignment: str) -> list[GeneratedMutant]:
    """Return a sample of the mutants that the operators make of an assignment, always the same for one reference."""
    path = suites.hidden(assignment).folder / "survivors.yaml"
    reasons: dict[str, str] = yaml.safe_load(path.read_text(encoding="utf-8")) if path.is_file() else {}
    found = list(_all(assignment, reasons))
    drawn = sorted(found, key=lambda mutant: hashlib.sha256(mutant.id.encode()).digest())[:SAMPLE_SIZE]
    return [mutant for mutant in found if mutant in drawn]


def _all(assignment: str, reasons: dict[str, str]) -> Iterator[GeneratedMutant]:
    for file, functions in _written_by_students(assignment):
        text = (layout.SOLUTIONS / file).read_text(encoding="utf-8")
        module = file.rpartition("/")[2].removesuffix(".py")
        count: Counter[tuple[str, str]] = Counter()
        for change in changes(text, functions):
            count[change.function, change.operator] += 1
            name = f"{module}.{change.function}.{change.operator}.{count[change.function, change.operator]}"
            yield GeneratedMutant(name, file, change.apply(text), reasons.get(name, ""))


def _written_by_students(assignment: str) -> Iterator[tuple[str, frozenset[str] | None]]:
    """Yield (path, functions) of each Python file of which students write functions. None stands for all functions."""
    packages = suites.hidden(assignment).packages
    for cell in Chapter(layout.chapter(assignment)).read().cells:
        copied = origin(cell) if is_solution(cell) else None
        if copied is None or copied.source.suffix != ".py" or copied.source.parts[0] not in packages:
            continue
        if copied.source.name == "setup.py" or copied.source.parts[1] in ("launch", "test"):
            continue
        yield str(copied.source), frozenset(copied.hide) - {"main"} if copied.hide else None
