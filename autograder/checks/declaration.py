"""What a check is: one function, one behaviour, and the sentence that the student reads.

A suite is a pytest module. Each of its tests is a check:

    @check(points=2, group="reaction", depends=("starts",), hints=("Where is 0 rad in a scan?", "..."))
    def test_turns_when_blocked(robot: Robot) -> None:
        \"\"\"The robot turns when something stands within 1 m in front of it.\"\"\"
        ...
        expect(turned, "it kept driving straight at a wall 0.6 m ahead")

A check passes, fails (with the fraction of its points that was reached) or is not checked because a check that it
depends on did not pass. Any other exception is the grader's own failure, never the student's zero.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any, TypeVar

from autograder.exceptions import GraderError

F = TypeVar("F", bound=Callable[..., Any])
PREFIX = "test_"


class Visibility(str, Enum):
    """Who sees a check, and when."""

    VISIBLE = "visible"
    HIDDEN = "hidden"
    AFTER_DUE = "after_due"


class Outcome(str, Enum):
    """How a check ended."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_CHECKED = "not_checked"

    @property
    def words(self) -> str:
        """The outcome as people read it, in feedback and in notebooks."""
        return self.value.replace("_", " ")


@dataclass(frozen=True)
class Check:
    """A check's contract, taken from its function and the `check` decorator.

    Attributes:
        id: the function's name without `test_`; unique in its suite.
        title: the first paragraph of its docstring.
        points: what it is worth, above 0.
        group: the locked grade cell that it counts for.
        hints: shown one after the other when it fails.
        doc: a page to read, or None.
        depends: ids of checks that must have passed first; they stand earlier in the suite.
    """

    id: str
    title: str
    points: float
    group: str
    visibility: Visibility
    hints: tuple[str, ...]
    doc: str | None
    depends: tuple[str, ...]


class CheckFailed(Exception):
    """A check's verdict "failed": a sentence for the student and the fraction of the points that was reached."""

    def __init__(self, message: str, *, fraction: float = 0.0) -> None:
        super().__init__(message)
        if not (math.isfinite(fraction) and 0.0 <= fraction < 1.0):
            raise GraderError(f"a failed check's fraction must be in [0, 1), not {fraction!r}")
        self.message = message
        self.fraction = fraction


def check(
    *,
    points: float,
    group: str,
    hints: tuple[str, ...] = (),
    doc: str | None = None,
    depends: tuple[str, ...] = (),
    visibility: Visibility = Visibility.HIDDEN,
) -> Callable[[F], F]:
    """Declare a pytest function a check.

    Raises:
        GraderError: the function's name, docstring or points break the contract of a check.
    """

    def declare(function: F) -> F:
        name = function.__name__
        title = " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())
        if not name.startswith(PREFIX):
            raise GraderError(f"check {name!r}: its name must start with {PREFIX!r}")
        if not title:
            raise GraderError(f"check {name!r}: it needs a docstring, the sentence that the student reads")
        if not (math.isfinite(points) and points > 0):
            raise GraderError(f"check {name!r}: points must be above 0, not {points!r}")
        declared = Check(name.removeprefix(PREFIX), title, float(points), group, visibility, hints, doc, depends)
        function.__check__ = declared  # type: ignore[attr-defined]
        return function

    return declare


def expect(condition: bool, message: str, *, fraction: float = 0.0) -> None:
    """Fail the check with `message` unless `condition` holds.

    Raises:
        CheckFailed: it does not hold.
    """
    if not condition:
        raise CheckFailed(message, fraction=fraction)


def declared(function: object) -> Check | None:
    """Return the check that a function declares, or None."""
    found = getattr(function, "__check__", None)
    return found if isinstance(found, Check) else None
