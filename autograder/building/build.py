"""Builds the packages that a suite requires. A failed build ends the grading, unless the suite allows one."""

from __future__ import annotations

import math
import subprocess
import time
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from autograder.building.colcon import StoppedBuildError, colcon_build, require_contained
from autograder.building.interface_bundle import install_bundle, interface_bundle
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.result.model import Build
from autograder.run.workspace import Workspace
from autograder.submission.exercise_stubs import explain
from autograder.submission.packages import Package, read_packages


@dataclass(frozen=True)
class BuildOutcome:
    """The build of a suite's packages, and a diagnosis for each package: OK if it was built."""

    build: Build
    diagnoses: Mapping[str, Diagnosis]

    @property
    def diagnosis(self) -> Diagnosis:
        """The diagnosis of the first package that was not built, or OK."""
        return next((diagnosis for diagnosis in self.diagnoses.values() if diagnosis is not OK), OK)


def require_packages(source: Path, required: tuple[str, ...], *, complete: bool = True) -> dict[str, Package]:
    """Return the packages in `source`; raise a StudentError if a required one is missing or incomplete.

    If `complete` is set, each required package needs the files that every Python package of ROS 2 has. Otherwise,
    colcon decides whether a package is complete.
    """
    packages, broken = read_packages(source)
    for name in required:
        package = packages.get(name)
        if package is None and broken:
            sentence = broken.get(source / name, next(iter(broken.values())))
            raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
        if package is None:
            raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, _missing(source, name, packages)))
        folder = package.folder
        if not complete or (folder / "CMakeLists.txt").is_file():
            continue
        for part in ("setup.py", "setup.cfg", f"resource/{name}", f"{name}/__init__.py"):
            if not (folder / part).exists():
                sentence = (
                    f"src/{folder.name} has no {part}: the package is incomplete, because colcon needs that file."
                )
                raise StudentError(Diagnosis(Kind.HALF_WRITTEN_PACKAGE, sentence))
    return packages


def build(workspace: Workspace, required: tuple[str, ...], *, complete: bool = False) -> Build:
    """Build the required packages of a workspace, and those that they depend on, with colcon.

    Interface packages are taken from the cache of builds if identical ones were built before. If a build fails, the
    detail of the StudentError contains the end of colcon's output. `require_packages` explains `complete`.
    """
    start = time.monotonic()
    packages = require_packages(workspace.root / "src", required, complete=complete)
    bundle = interface_bundle(packages, required)
    if bundle:
        install_bundle(bundle, workspace)
    if set(required) - set(bundle):
        skip_options = ["--packages-skip", *bundle] if bundle else []
        folders = [package.folder for package in packages.values()]
        colcon_build(workspace, folders, "--packages-up-to", *required, *skip_options)
    return Build(True, round(time.monotonic() - start, 2), tuple(sorted(packages)))


def build_workspace(workspace: Workspace, packages: tuple[str, ...], *, may_fail: bool = False) -> BuildOutcome:
    """Build packages of a workspace.

    If the build fails and `may_fail` is set, each package is built separately, so that an error in one does not affect
    another. In this case, colcon decides whether a package is complete.

    Raises:
        StudentError: a required package is missing or does not build, a limit ended a build, or the build created files
            that must not be read.
    """
    source = workspace.root / "src"
    try:
        return BuildOutcome(build(workspace, packages, complete=not may_fail), dict.fromkeys(packages, OK))
    except StudentError as error:
        if not may_fail or isinstance(error, StoppedBuildError):
            raise StudentError(explain(error.diagnosis, source, *packages)) from None
    subprocess.run(["rm", "-rf", "--", workspace.root / "build", workspace.install], check=True)
    builds: list[Build] = []
    diagnoses: dict[str, Diagnosis] = {}
    for name in packages:
        try:
            builds.append(build(workspace, (name,)))
            diagnoses[name] = OK
        except StoppedBuildError:
            raise
        except StudentError as error:
            builds.append(Build(False, 0.0, log=error.diagnosis.detail))
            diagnoses[name] = explain(error.diagnosis, source, name)
    require_contained(workspace.install)  # not yet done after a failed build
    names = tuple(sorted({name for single in builds for name in single.packages}))
    log = "\n".join(filter(None, (single.log for single in builds)))
    seconds = round(math.fsum(single.seconds for single in builds), 2)
    return BuildOutcome(Build(all(single.ok for single in builds), seconds, names, log), diagnoses)


def _missing(source: Path, name: str, packages: Collection[str]) -> str:
    if not source.is_dir():
        return f"There is no ws/src folder: create the package {name} in it."
    if (source / name).is_dir():
        return f"src/{name} has no package.xml with <name>{name}</name>: without it, colcon does not find a package."
    names = ", ".join(sorted(packages)) or "no package"
    return f"The package {name} is missing: src contains {names}."
