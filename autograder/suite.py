"""A suite: the checks of one assignment, read from the modules of one package.

A suite's package says in `PACKAGES` which ROS 2 packages a submission must bring, and in `MODULES` which of its modules
hold checks, in the order in which they are run. `FOLDERS`, if it is there, names what a submission brings in `src`
besides: folders that are no packages. `READS`, if it is there, names files and folders of the course, by their paths
below its root, that the checks read besides what lies in their own packages.

A suite that looks at the sources, too, says `BUILD_MAY_FAIL = True`: then a package that is missing or does not build
does not end the grading. It is something that the checks see, by the fixture `builds`, and those that need a built
package depend on one that asks for it.
"""

from __future__ import annotations

import importlib
import inspect
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from autograder import fingerprint
from autograder.checks import Check, declared
from autograder.exceptions import GraderError, UsageError


@dataclass(frozen=True)
class Suite:
    """The checks of an assignment, hidden or visible.

    Attributes:
        assignment: the assignment that it judges.
        packages: ROS 2 packages that a submission must bring.
        files: its modules, in the order in which they are run.
        checks: every check in that order.
        build_may_fail: whether its checks are run even if a package is missing or does not build.
        folders: what a submission brings in `src` besides its packages.
        reads: files and folders of the course that its checks read besides their own packages, by their paths.
    """

    assignment: str
    packages: tuple[str, ...]
    files: tuple[Path, ...]
    checks: tuple[Check, ...]
    build_may_fail: bool = False
    folders: tuple[str, ...] = ()
    reads: tuple[str, ...] = ()

    @cached_property
    def version(self) -> str:
        """A digest of every file that a grading with the suite reads."""
        return fingerprint.digest(self.assignment, self.reads)

    @property
    def sources(self) -> tuple[str, ...]:
        """The folders of `src` that an answer is made of: the packages and the rest."""
        return self.packages + self.folders

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


def read(home: str, assignment: str) -> Suite:
    """Read the suite of an assignment from the package `home`.chASSIGNMENT.

    Raises:
        UsageError: there is none.
        GraderError: it breaks the contract of a check.
    """
    package = f"{home}.ch{assignment}"
    try:
        described = importlib.import_module(package)
    except ModuleNotFoundError as error:
        if error.name not in (package, home):
            raise
        raise UsageError(f"there are no checks for {assignment!r}; there are for: {', '.join(names(home))}") from None
    modules = [importlib.import_module(f"{package}.{name}") for name in described.MODULES]
    files = tuple(Path(inspect.getfile(module)) for module in modules)
    checks = [found for module in modules for value in vars(module).values() if (found := declared(value))]
    _require_order(assignment, checks)
    return Suite(
        assignment,
        tuple(described.PACKAGES),
        files,
        tuple(checks),
        getattr(described, "BUILD_MAY_FAIL", False),
        tuple(getattr(described, "FOLDERS", ())),
        tuple(getattr(described, "READS", ())),
    )


def names(home: str) -> list[str]:
    """Return the names of the assignments that have a suite in the package `home`."""
    folder = Path(inspect.getfile(importlib.import_module(home))).parent
    return sorted(path.parent.name.removeprefix("ch") for path in folder.glob("ch*/__init__.py"))


def _require_order(assignment: str, checks: list[Check]) -> None:
    seen: set[str] = set()
    for check in checks:
        if check.id in seen:
            raise GraderError(f"{assignment}: two checks are called {check.id!r}")
        unmet = set(check.depends) - seen
        if unmet:
            raise GraderError(f"{assignment}: {check.id!r} depends on {sorted(unmet)}, which must stand before it")
        seen.add(check.id)
