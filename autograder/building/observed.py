"""Building what a suite wants: a build that fails ends the grading, or is something that the checks see."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass

from autograder.building.build import build, require_packages
from autograder.building.colcon import require_contained
from autograder.diagnosis import OK, Diagnosis
from autograder.exceptions import StudentError
from autograder.result import Build
from autograder.unwritten import explain
from autograder.workspace import Workspace


@dataclass(frozen=True)
class Observed:
    """How building a suite's packages went all together, and by package; OK for one that was built."""

    build: Build
    diagnoses: Mapping[str, Diagnosis]

    @property
    def diagnosis(self) -> Diagnosis:
        """The first package's that was not built, or OK."""
        return next((found for found in self.diagnoses.values() if found is not OK), OK)


def build_workspace(workspace: Workspace, packages: tuple[str, ...], *, may_fail: bool = False) -> Observed:
    """Build packages of a workspace.

    Where a build may fail, and does, each package is built by itself, so that one's error is not the other's. Colcon
    alone judges then whether a package is whole.

    Raises:
        StudentError: one is missing or does not build, and may not; or the build left what must not be looked at.
    """
    source = workspace.root / "src"
    try:
        require_packages(source, packages, whole=not may_fail)
        return Observed(build(workspace, packages), dict.fromkeys(packages, OK))
    except StudentError as error:
        if not may_fail:
            raise StudentError(explain(error.diagnosis, source, *packages)) from None
    subprocess.run(["rm", "-rf", "--", workspace.root / "build", workspace.install], check=True)
    builds: list[Build] = []
    diagnoses: dict[str, Diagnosis] = {}
    for name in packages:
        try:
            require_packages(source, (name,), whole=False)
            builds.append(build(workspace, (name,)))
            diagnoses[name] = OK
        except StudentError as error:
            builds.append(Build(False, 0.0, log=error.diagnosis.detail))
            diagnoses[name] = explain(error.diagnosis, source, name)
    require_contained(workspace.install)  # a build that failed was not looked at yet
    seen = tuple(sorted({name for each in builds for name in each.packages}))
    log = "\n".join(filter(None, (each.log for each in builds)))
    seconds = round(math.fsum(each.seconds for each in builds), 2)
    return Observed(Build(all(each.ok for each in builds), seconds, seen, log), diagnoses)
