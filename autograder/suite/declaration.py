"""Declares checks. A check is a function that tests one behaviour, with the sentence that the student reads.

A suite consists of pytest modules. Each test in them is a check, and belongs to the group that its module names:

    check = group("reaction")

    @check(points=2, covers="turns", needs=("starts",), doc=contract.LASER_SCAN)
    @hint("Where is 0 rad in a scan?")
    @hint("Compare the smallest forward range with 1.0.")
    def test_turns_when_blocked(robot: Robot) -> None:
        \"\"\"The robot turns when something is within 1 m in front of it.\"\"\"
        ...
        expect(turned, "it kept driving straight at a wall 0.6 m ahead")

`check` itself takes the group as an argument, for modules whose checks belong to several groups. `check_each_row`
declares a check for every row of a table. A check in a folder called `visible` is visible, any other is hidden.

A check passes, fails (with a fraction of its points) or is not checked, because a check that it `needs` did not pass:
for example, no program starts, or a topic does not exist. A check `after` another one runs in any case and tests its
own requirement. If both fail, feedback shows it under the other one. An unexpected exception is a failure of the
grader, and never gives a student zero points.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any, Protocol, TypeVar

from autograder.exceptions import AutograderError, GraderError

F = TypeVar("F", bound=Callable[..., Any])
PREFIX = "test_"


class Visibility(str, Enum):
    """Whether students get the source of a check."""

    VISIBLE = "visible"
    HIDDEN = "hidden"


class Outcome(str, Enum):
    """The outcome of a check."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_CHECKED = "not_checked"

    @property
    def text(self) -> str:
        """The outcome in words, for feedback and notebooks."""
        return self.value.replace("_", " ")


@dataclass(frozen=True)
class Check:
    """What a check's function and its `check` decorator declare.

    Attributes:
        id: the function's name without `test_`; unique in its suite.
        title: the first paragraph of its docstring.
        points: the points that it can earn, above 0.
        group: the locked grade cell to which its points belong.
        hints: shown one after the other when it fails.
        doc: a page to read, or None.
        needs: ids of checks without which this one cannot be run; it runs only if all of them passed.
        covers: ids of the requirements that it covers; see `autograder.suite.contract`.
        after: ids of checks whose failure is a likely cause if this one also fails; it runs in any case.
    """

    id: str
    title: str
    points: float
    group: str
    visibility: Visibility
    hints: tuple[str, ...]
    doc: str | None
    needs: tuple[str, ...] = ()
    covers: tuple[str, ...] = ()
    after: tuple[str, ...] = ()

    @property
    def dependencies(self) -> tuple[str, ...]:
        """Ids of the checks in `needs` and `after`. They are declared earlier in the suite."""
        return self.needs + self.after


class FractionError(GraderError, ValueError):
    """A failed check's fraction is invalid: the check is wrong, or did not expect the data that it used."""


class CheckFailed(AutograderError):
    """A check's verdict "failed": a sentence for the student and the fraction of the points that the check earns.

    `hints` are the hints for this failure, or None for those of the check.
    """

    def __init__(self, message: str, *, fraction: float = 0.0, hints: tuple[str, ...] | None = None) -> None:
        super().__init__(message)
        if not (math.isfinite(fraction) and 0.0 <= fraction < 1.0):
            raise FractionError(f"a failed check's fraction must be in [0, 1), not {fraction!r}")
        self.message = message
        self.fraction = fraction
        self.hints = hints


class Declare(Protocol):
    """Declares functions as checks of one group; see `check`."""

    def __call__(
        self,
        *,
        points: float,
        covers: str | tuple[str, ...] = ...,
        needs: tuple[str, ...] = ...,
        after: tuple[str, ...] = ...,
        doc: str | None = ...,
    ) -> Callable[[F], F]: ...


@dataclass(frozen=True, kw_only=True)
class CheckRow:
    """A row in a table of checks that share a body. A subclass adds the fields that the body needs.

    `Check` explains the attributes.
    """

    id: str
    title: str
    points: float
    hints: tuple[str, ...]
    doc: str
    covers: str | tuple[str, ...] = ()


R = TypeVar("R", bound=CheckRow)


def check(
    *,
    points: float,
    group: str,
    covers: str | tuple[str, ...] = (),
    needs: tuple[str, ...] = (),
    after: tuple[str, ...] = (),
    doc: str | None = None,
) -> Callable[[F], F]:
    """Declare a pytest function as a check.

    Args:
        points: the points that it can earn, above 0.
        group: the locked grade cell to which its points belong.
        covers: ids of the requirements that it covers, or a single id.
        needs: ids of checks without which this one cannot be run; it runs only if all of them passed.
        after: ids of checks whose failure is a likely cause if this one also fails; it runs in any case.
        doc: a page to read, or None.

    Raises:
        GraderError: the function's name, docstring or points are not valid for a check.
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
        is_visible = Path(inspect.unwrap(function).__code__.co_filename).parent.name == Visibility.VISIBLE.value
        visibility = Visibility.VISIBLE if is_visible else Visibility.HIDDEN
        hints = getattr(function, "__hints__", ())
        requirement_ids = (covers,) if isinstance(covers, str) else covers
        id = name.removeprefix(PREFIX)
        new_check = Check(id, title, float(points), group, visibility, hints, doc, needs, requirement_ids, after)
        function.__check__ = new_check  # type: ignore[attr-defined]
        return function

    return declare


def group(name: str, *, needs: tuple[str, ...] = (), after: tuple[str, ...] = (), doc: str | None = None) -> Declare:
    """Return `check` for one group, with defaults for the `needs`, `after` and `doc` of its checks."""
    default_needs, default_after, default_doc = needs, after, doc

    def check_of_group(
        *,
        points: float,
        covers: str | tuple[str, ...] = (),
        needs: tuple[str, ...] = default_needs,
        after: tuple[str, ...] = default_after,
        doc: str | None = default_doc,
    ) -> Callable[[F], F]:
        return check(points=points, group=name, covers=covers, needs=needs, after=after, doc=doc)

    return check_of_group


def hint(*texts: str) -> Callable[[F], F]:
    """Add hints to the function of a check, before those of the `hint` below it. Use it below `check`.

    Raises:
        GraderError: it is used above `check`, which would ignore the hints.
    """

    def add(function: F) -> F:
        if check_of(function):
            raise GraderError(f"check {function.__name__!r}: its hints must be below `check`, not above")
        function.__hints__ = (*texts, *getattr(function, "__hints__", ()))  # type: ignore[attr-defined]
        return function

    return add


def check_each_row(check: Declare, rows: Iterable[R]) -> Callable[[F], F]:
    """Declare a check for each row of a table, as a function `test_ID` in the module of the body.

    The body is a function whose first argument is a row. Its other arguments are fixtures.

    Args:
        check: declares each check, with the row's points and page.
        rows: the rows of the table.

    Raises:
        GraderError: pytest would collect the body itself as a test.
    """

    def declare_each(body: F) -> F:
        if body.__name__.startswith("test"):
            raise GraderError(
                f"body {body.__name__!r}: its name must not start with 'test', because its checks' names do"
            )
        for row in rows:
            declare = check(points=row.points, covers=row.covers, doc=row.doc)
            body.__globals__[PREFIX + row.id] = declare(hint(*row.hints)(_with_row(body, row)))
        return body

    return declare_each


def expect(condition: bool, message: str, *, fraction: float = 0.0, hints: tuple[str, ...] | None = None) -> None:
    """Fail the check with `message` unless `condition` holds. `hints` replace those of the check.

    Raises:
        CheckFailed: it does not hold.
    """
    if not condition:
        raise CheckFailed(message, fraction=fraction, hints=hints)


def check_of(function: object) -> Check | None:
    """Return the check that a function declares, or None."""
    declared = getattr(function, "__check__", None)
    return declared if isinstance(declared, Check) else None


def _with_row(body: Callable[..., None], row: CheckRow) -> Callable[..., None]:
    """Return a test that calls a body with a row, and asks pytest for the body's fixtures."""

    @functools.wraps(body)
    def test(**fixtures: Any) -> None:
        body(row, **fixtures)

    _, *fixtures = inspect.signature(body).parameters.values()
    test.__name__ = PREFIX + row.id
    test.__doc__ = row.title
    test.__signature__ = inspect.Signature(fixtures)  # type: ignore[attr-defined]
    return test
