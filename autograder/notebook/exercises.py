"""The exercises of a chapter, as numbered in its notebook, and the checks of each exercise.

A heading such as `Exercise 2: repair a package`, `Step 4: ...` or `Question 3: ...` starts an exercise. A heading
`Exercise` without a number is exercise 1. The requirements below the heading belong to the exercise
(`autograder.suite.contract`).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import mistune

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.submission.intake.writefile import written_file
from autograder.suite.declaration import Check

KINDS = ("exercise", "step", "question")
_HEADING = re.compile(rf"({'|'.join(KINDS)})(?: (\d+))?(?:: (.*))?", re.IGNORECASE)
_markdown = mistune.create_markdown(renderer=None)


@dataclass(frozen=True)
class Exercise:
    """An exercise of a chapter.

    Attributes:
        kind: its kind in the notebook, one of `KINDS`.
        number: its number in the heading.
        title: the rest of the heading.
        sentences: the ids of the requirements that it contains.
        groups: the groups of checks that the notebook's objectives assign only to this exercise.
        later: the files that only cells after this exercise write, such as `ws/src/robot/setup.py`.
    """

    kind: str
    number: int
    title: str
    sentences: tuple[str, ...] = ()
    groups: tuple[str, ...] = ()
    later: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Its name in the notebook and in commands, such as `step 2`."""
        return f"{self.kind} {self.number}"


def exercises(assignment: str) -> tuple[Exercise, ...]:
    """Return the exercises of a chapter that have checks, in the order of its notebook.

    Raises:
        UsageError: the chapter does not exist, or its notebook cannot be read.
    """
    path = course_paths.source_notebook(assignment)
    try:
        notebook = json.loads(path.read_bytes())
        return tuple(_read_exercises(notebook["cells"], notebook["metadata"].get("course", {}).get("objectives", ())))
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        hint = "save it in JupyterLab, or check the whole chapter"
        raise UsageError(f"{path} cannot be read as a notebook: {hint}") from None


def find_exercise(assignment: str, available: Sequence[Exercise], kind: str, number: int) -> Exercise:
    """Return an exercise of a chapter.

    Raises:
        UsageError: the chapter has no such exercise. The message lists the existing ones.
    """
    for exercise in available:
        if (exercise.kind, exercise.number) == (kind, number):
            return exercise
    in_order = sorted(available, key=lambda exercise: (exercise.kind, exercise.number))
    known_exercises = ", ".join(f"{entry.name} ({entry.title})" if entry.title else entry.name for entry in in_order)
    raise UsageError(f"{assignment} has no {kind} {number}; it has: {known_exercises or 'no exercise with a number'}")


def checks_of(exercise: Exercise, available: Sequence[Exercise], checks: Sequence[Check]) -> tuple[str, ...]:
    """Return the ids of the checks that belong to an exercise, in the order of the suite.

    If all requirements of a group of checks are in one exercise, the group belongs to that exercise. If they are in
    several, the notebook's objectives decide. If the objectives do not assign the group to exactly one exercise, each
    check belongs to the last exercise that contains one of its requirements. A check belongs to every exercise if no
    exercise contains one of its requirements.
    """
    return tuple(check.id for check in checks if _exercise_of(check, available, checks) in (None, exercise))


def _exercise_of(check: Check, available: Sequence[Exercise], checks: Sequence[Check]) -> Exercise | None:
    """Return the exercise of a check, or None if no exercise contains one of its requirements."""
    group_exercises = [
        exercise for other in checks if other.group == check.group for exercise in _exercises_covering(other, available)
    ]
    if len(set(group_exercises)) > 1:
        assigned_exercise = next((exercise for exercise in available if check.group in exercise.groups), None)
        return assigned_exercise or next(reversed(_exercises_covering(check, available)), None)
    return next(iter(_exercises_covering(check, available)), None)


def _exercises_covering(check: Check, available: Sequence[Exercise]) -> list[Exercise]:
    return [exercise for exercise in available if not set(exercise.sentences).isdisjoint(check.covers)]


def _read_exercises(cells: Sequence[Any], objectives: Sequence[Any]) -> Iterator[Exercise]:
    """Yield the exercises in these cells. `objectives` are those in the notebook's metadata."""
    cells_of_group: dict[str, set[str]] = {}  # for each group, the ids of the cells with the exercises that it tests
    for objective in objectives:
        for group in objective["groups"]:
            cells_of_group.setdefault(group, set()).add(objective["exercise"])
    by_name: dict[str, Exercise] = {}
    sentences: dict[str, dict[str, Any]] = {}
    files: list[str] = []  # the files that cells write, in the order of the notebook
    file_counts: dict[str, int] = {}  # for each exercise, how many files the cells up to its end write
    level, current = 0, ""
    for cell in cells:
        for depth, text in _headings(cell):
            if heading := _HEADING.fullmatch(text):
                new = Exercise(heading[1].lower(), int(heading[2] or 1), heading[3] or "")
                level, current = depth, new.name
                groups = tuple(group for group, ids in cells_of_group.items() if ids == {cell.get("id")})
                by_name[current] = Exercise(new.kind, new.number, new.title, groups=groups)
            elif depth <= level:
                level, current = 0, ""
        if cell["cell_type"] == "code" and (file := written_file("".join(cell["source"]))):
            files.append(file[0].as_posix())
        if current:
            sentences.setdefault(current, {}).update(cell["metadata"].get("course", {}).get("contract", {}))
            file_counts[current] = len(files)
    for name, exercise in by_name.items():
        if requirements := sentences.get(name):  # a question that a person grades has none
            before, after = files[: file_counts[name]], files[file_counts[name] :]
            yield replace(
                exercise, sentences=tuple(requirements), later=tuple(file for file in after if file not in before)
            )


def _headings(cell: Any) -> Iterator[tuple[int, str]]:
    """Yield the level and the text of each heading of a cell."""
    if cell["cell_type"] == "markdown":
        tokens: Any = _markdown("".join(cell["source"]))
        yield from ((token["attrs"]["level"], _text(token)) for token in tokens if token["type"] == "heading")


def _text(token: dict[str, Any]) -> str:
    return token.get("raw") or "".join(_text(child) for child in token.get("children", ()))
