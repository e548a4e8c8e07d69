"""A suite: the visible or the hidden checks of one assignment, read from the modules of one package.

The `__init__.py` of the package, `chNN_name.visible` or `chNN_name.hidden`, contains:

    PACKAGES          the ROS 2 packages that a submission must contain
    MODULES           its modules with checks, in the order in which they are run
    GROUPS            optional: the groups of checks in the order in which results show them; by default, they follow
                      the order of MODULES
    FOLDERS           optional: folders in `src` that a submission contains besides its packages
    READS             optional: files and folders of the course that the checks read outside their own chapter's folder,
                      as paths below the course's root
    BUILD_MAY_FAIL    optional: if True, a package that is missing or does not build does not end the grading. The
                      fixture `builds` tells checks what was built. A check that requires a built package names, in
                      `needs`, a check that fails if the package was not built.
    OWN_TESTS         optional: the checks that lose points if the submission's own tests of its other files fail
"""

from __future__ import annotations

import importlib
import inspect
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from threading import RLock

from autograder.exceptions import GraderError, UsageError
from autograder.suite import fingerprint
from autograder.suite.declaration import Check, check_of

HOME = "autograder.checks"
VISIBLE, HIDDEN = "visible", "hidden"
_import_lock = RLock()  # otherwise, two threads that import checks could wait for each other's modules


@dataclass(frozen=True)
class Suite:
    """The checks of an assignment, hidden or visible.

    Attributes:
        assignment: the assignment that it grades.
        packages: ROS 2 packages that a submission must contain.
        files: its modules, in the order in which they are run.
        checks: every check, in the order in which results show them.
        build_may_fail: whether its checks are run even if a package is missing or does not build.
        folders: the folders that a submission contains in `src` besides its packages.
        reads: paths of the files and folders of the course that its checks read besides their own packages.
        own_tests: ids of the checks that lose points if the submission's own tests of its other files fail.
    """

    assignment: str
    packages: tuple[str, ...]
    files: tuple[Path, ...]
    checks: tuple[Check, ...]
    build_may_fail: bool = False
    folders: tuple[str, ...] = ()
    reads: tuple[str, ...] = ()
    own_tests: tuple[str, ...] = ()

    @cached_property
    def version(self) -> str:
        """The version, which changes when marks may change; see `fingerprint.version`."""
        return fingerprint.version(self.assignment, self.reads)

    @cached_property
    def files_digest(self) -> str:
        """A digest of every file that a grading with the suite reads."""
        return fingerprint.digest(self.assignment, self.reads)

    @property
    def folder(self) -> Path:
        """The folder of the chapter's checks."""
        return self.files[0].parents[1]

    @property
    def sources(self) -> tuple[str, ...]:
        """The folders of `src` that an answer consists of: the packages and the others."""
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

    def with_dependencies(self, *ids: str) -> tuple[str, ...]:
        """Return the ids of checks and of all checks that they need, in the order of the suite."""
        needs, needed_ids, pending = {check.id: check.needs for check in self.checks}, set[str](), list(ids)
        while pending:
            if (name := pending.pop()) not in needed_ids:
                needed_ids.add(name)
                pending += needs.get(name, ())
        return tuple(check.id for check in self.checks if check.id in needed_ids)


@cache
def hidden(assignment: str) -> Suite:
    """Return the suite that grades an assignment. The errors are those of `read`."""
    return read(HOME, assignment, HIDDEN)


@cache
def visible(assignment: str) -> Suite:
    """Return the checks of an assignment that students run themselves. The errors are those of `read`."""
    return read(HOME, assignment, VISIBLE)


def graded_assignments() -> list[str]:
    """Return the names of the assignments that have a hidden suite."""
    return assignments_with(HOME, HIDDEN)


def checkable_assignments() -> list[str]:
    """Return the names of the assignments that have visible checks."""
    return assignments_with(HOME, VISIBLE)


def read(home: str, assignment: str, kind: str) -> Suite:
    """Read the suite of an assignment from the package `home`.chASSIGNMENT.`kind`.

    Args:
        home: the package that contains a package for each chapter.
        assignment: the assignment's name.
        kind: "visible" or "hidden".

    Raises:
        UsageError: the suite does not exist.
        GraderError: the suite or one of its checks is not valid.
    """
    package = f"{home}.ch{assignment}.{kind}"
    if assignment not in (existing_assignments := assignments_with(home, kind)):
        raise UsageError(
            f"there are no {kind} checks for {assignment!r}; there are for: {', '.join(existing_assignments)}"
        )
    with _import_lock:
        suite_module = importlib.import_module(package)
        modules = [importlib.import_module(f"{package}.{name}") for name in suite_module.MODULES]
    files = tuple(Path(inspect.getfile(module)) for module in modules)
    checks = [declared for module in modules for value in vars(module).values() if (declared := check_of(value))]
    _require_order(assignment, checks)
    if groups := getattr(suite_module, "GROUPS", ()):
        if unlisted_groups := {check.group for check in checks}.difference(groups):
            raise GraderError(f"{assignment}: GROUPS of the {kind} checks does not name {sorted(unlisted_groups)}")
        checks.sort(key=lambda check: groups.index(check.group))
    return Suite(
        assignment,
        tuple(suite_module.PACKAGES),
        files,
        tuple(checks),
        getattr(suite_module, "BUILD_MAY_FAIL", False),
        tuple(getattr(suite_module, "FOLDERS", ())),
        tuple(getattr(suite_module, "READS", ())),
        tuple(getattr(suite_module, "OWN_TESTS", ())),
    )


def assignments_with(home: str, kind: str) -> list[str]:
    """Return the names of the assignments that have a suite of this kind in the package `home`."""
    folder = Path(importlib.import_module(home).__path__[0])
    return sorted(path.parents[1].name.removeprefix("ch") for path in folder.glob(f"ch*/{kind}/__init__.py"))


def _require_order(assignment: str, checks: list[Check]) -> None:
    earlier_ids: set[str] = set()
    for check in checks:
        if check.id in earlier_ids:
            raise GraderError(f"{assignment}: two checks are called {check.id!r}")
        missing_ids = set(check.dependencies) - earlier_ids
        if missing_ids:
            raise GraderError(f"{assignment}: {check.id!r} names {sorted(missing_ids)}, which must come before it")
        earlier_ids.add(check.id)
