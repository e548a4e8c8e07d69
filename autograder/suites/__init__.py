"""The hidden suites: one package an assignment, pytest modules whose tests are checks.

A suite's package says in `PACKAGES` which ROS 2 packages a submission must bring, and in `MODULES` which of its modules
hold checks, in the order in which they are run. Nothing of this folder is ever visible to students' code.
"""

from __future__ import annotations

import hashlib
import importlib
import inspect
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from autograder.checks import Check, declared
from autograder.exceptions import GraderError, UsageError


@dataclass(frozen=True)
class Suite:
    """A hidden suite.

    Attributes:
        assignment: the assignment that it grades.
        packages: ROS 2 packages that a submission must bring.
        files: its modules, in the order in which they are run.
        checks: every check in that order.
        version: changes whenever a file of the suite does.
    """

    assignment: str
    packages: tuple[str, ...]
    files: tuple[Path, ...]
    checks: tuple[Check, ...]
    version: str

    @property
    def max_score(self) -> float:
        """The sum of the checks' points."""
        return sum(check.points for check in self.checks)

    @property
    def groups(self) -> dict[str, float]:
        """The points of each group of checks, in the order of the suite."""
        points: dict[str, float] = {}
        for check in self.checks:
            points[check.group] = points.get(check.group, 0.0) + check.points
        return points


@cache
def load(assignment: str) -> Suite:
    """Load the suite of an assignment.

    Raises:
        UsageError: the assignment has none.
        GraderError: the suite breaks the contract of a check.
    """
    package = f"{__name__}.ch{assignment}"
    try:
        described = importlib.import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise UsageError(f"{assignment} has no hidden suite; graded assignments: {', '.join(graded())}") from None
    modules = [importlib.import_module(f"{package}.{name}") for name in described.MODULES]
    files = tuple(Path(inspect.getfile(module)) for module in modules)
    checks = [found for module in modules for value in vars(module).values() if (found := declared(value))]
    _require_order(assignment, checks)
    digest = hashlib.sha256()
    for path in sorted(Path(inspect.getfile(described)).parent.glob("*.py")):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return Suite(assignment, tuple(described.PACKAGES), files, tuple(checks), digest.hexdigest()[:12])


def manifest(assignment: str) -> tuple[Check, ...]:
    """Return an assignment's checks; the sum of their points is the maximum score. Raises as `load` does."""
    return load(assignment).checks


def graded() -> list[str]:
    """Return the names of the assignments that have a suite."""
    return sorted(path.parent.name.removeprefix("ch") for path in Path(__file__).parent.glob("ch*/__init__.py"))


def _require_order(assignment: str, checks: list[Check]) -> None:
    seen: set[str] = set()
    for check in checks:
        if check.id in seen:
            raise GraderError(f"{assignment}: two checks are called {check.id!r}")
        unmet = set(check.depends) - seen
        if unmet:
            raise GraderError(f"{assignment}: {check.id!r} depends on {sorted(unmet)}, which must stand before it")
        seen.add(check.id)
