"""One `colcon build` in the sandbox, and the diagnosis if it fails."""

from __future__ import annotations

import glob
import os
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from autograder.building import cmake_overlay
from autograder.building.build_log import first_error, readable
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.lockstep.failures import tail
from autograder.run.sandbox import ExitReason, Mount
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import BUILD, INSTALLED
from autograder.run.sandbox.trees import Entry, TreeError, read_tree, survey
from autograder.run.workspace import Workspace

RUNNER = Path(__file__).with_name("colcon_runner.py")
LOG_LINES = 40


class StoppedBuildError(StudentError):
    """A limit ended the build. Another try would take as long, and a grading has no time for that."""


def colcon_command(workspace: Workspace, folders: Iterable[Path], verb: str, *words: str) -> list[str]:
    """Return the command line of `colcon VERB WORDS...` in a sandbox, on the packages in some folders of the workspace.

    Without this, colcon might find other packages than the judged ones.
    """
    command = [sys.executable, str(RUNNER), "--log-base", str(workspace.scratch / "colcon-log"), verb]
    # colcon reads a build's two streams separately, so their combined output has a different order each time.
    together = "console_cohesion-" if verb == "build" else "console_cohesion+"
    paths = sorted(glob.escape(str(folder.relative_to(workspace.root))) for folder in folders)
    return [*command, "--paths", *paths, "--event-handlers", together, "desktop_notification-", *words]


def colcon_build(workspace: Workspace, folders: Iterable[Path], *choice: str) -> None:
    """Run `colcon build` on a workspace, without a network.

    The workspace alone is writable for the build. `folders` are its packages, and `choice` colcon's own
    options for choosing among them.

    Raises:
        StudentError: it did not build, or its files are not contained; the detail has the end of the output. If a limit
            ended the build, it is a StoppedBuildError.
    """
    with workspace.apart() as folder:
        overlay = cmake_overlay.write_overlay(workspace.ros.prefixes, folder / "cmake-overlay")
        output, exit_reason, status = _run(workspace, overlay, colcon_command(workspace, folders, "build", *choice))
        output = output.replace(str(folder), "~")
    if exit_reason is not ExitReason.EXITED or status != 0:
        # Two gradings of one submission differ in the place of their workspace. Students know it as ws.
        output = output.replace(str(workspace.root), "ws").replace(str(workspace.scratch), "~")
        error = StudentError if exit_reason is ExitReason.EXITED else StoppedBuildError
        raise error(
            Diagnosis(Kind.BUILD_FAILED, _build_failure(output, exit_reason), tail(readable(output), LOG_LINES))
        )
    require_contained(workspace.install)


def _run(workspace: Workspace, overlay: Path, command: list[str]) -> tuple[str, ExitReason | None, int | None]:
    plain = workspace.sandbox(BUILD)
    environment = {
        **plain.environment,
        "CMAKE_PREFIX_PATH": os.pathsep.join([str(overlay), plain.environment["CMAKE_PREFIX_PATH"]]),
        "COLCON_HOME": str(workspace.scratch),
        "MAKEFLAGS": f"-j{min(3, (os.cpu_count() or 1) + 1)}",
    }
    mounts = (*plain.mounts, Mount(RUNNER), Mount(workspace.root, writable=True), Mount(overlay))
    spec = replace(plain, workdir=workspace.root, mounts=mounts, environment=environment, network=False)
    with launch(command, spec, profile="colcon") as process:
        process.wait(BUILD.wall_seconds + 10)
        return process.output, process.exit_reason, process.returncode


def require_contained(install: Path) -> None:
    """Raise a StudentError if an install space is too large, or contains more than files, folders and inner links.

    It is mounted for nodes, and a mount would follow a link. It is copied, and a copy fills the holes of a file.
    """
    if install.is_symlink():
        raise _left(f"{install.name}, which leads out of the install space")
    if install.exists():
        try:
            survey(install, INSTALLED)
        except TreeError as error:
            raise _left(str(error)) from None


def read_installed(install: Path) -> dict[Entry, bytes]:
    """Read an install space, or raise a StudentError as `require_contained` does, or where it cannot be read."""
    require_contained(install)
    try:
        return read_tree(install, INSTALLED) if install.exists() else {}
    except TreeError as error:
        raise _left(str(error)) from None


def _left(what: str) -> StudentError:
    sentence = f"The build left {what}: setup.py and CMakeLists.txt must install plain files of the package alone."
    return StudentError(Diagnosis(Kind.BUILD_FAILED, sentence))


def _build_failure(output: str, exit_reason: ExitReason | None) -> str:
    if exit_reason is not ExitReason.EXITED and exit_reason is not None:
        why = exit_reason.value.replace("_", " ")
        return f"colcon build was stopped ({why}): a build should end within a minute or two."
    if "specified with --packages-up-to was not found" in output:
        return (
            "colcon does not see the package, because its package.xml breaks a rule of ROS: run colcon build and read "
            "what follows “Failed to parse ROS package manifest”."
        )
    # Before that, colcon only reads src, and complains about packages that this build does not need.
    output = output[max(output.find("Starting >>> "), 0) :]
    first = first_error(output)
    return f"colcon build failed. The first error: {first}" if first else "colcon build failed."
