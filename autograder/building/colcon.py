"""Runs `colcon build` in the sandbox, and diagnoses a failed build."""

from __future__ import annotations

import glob
import os
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from autograder.building import cmake_overlay
from autograder.building.build_log import first_error, readable_log
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.lockstep.failures import tail
from autograder.run.sandbox import ExitReason, Mount
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import BUILD, INSTALLED
from autograder.run.sandbox.trees import Entry, TreeError, list_tree, read_tree
from autograder.run.workspace import Workspace

RUNNER = Path(__file__).with_name("colcon_runner.py")
LOG_LINES = 40  # of the end of a log, which a diagnosis contains


class StoppedBuildError(StudentError):
    """A limit stopped the build. It is not repeated, because a grading has no time for a second build that long."""


def colcon_command(workspace: Workspace, folders: Iterable[Path], verb: str, *options: str) -> list[str]:
    """Return the command line of `colcon VERB OPTIONS...` in a sandbox, for the packages in these folders.

    Without the folders, colcon could find packages that are not graded.
    """
    command = [sys.executable, str(RUNNER), "--log-base", str(workspace.scratch / "colcon-log"), verb]
    # colcon reads the two output streams of a build separately, so a combined output has a different order each time.
    cohesion = "console_cohesion-" if verb == "build" else "console_cohesion+"
    paths = sorted(glob.escape(str(folder.relative_to(workspace.root))) for folder in folders)
    return [*command, "--paths", *paths, "--event-handlers", cohesion, "desktop_notification-", *options]


def colcon_build(workspace: Workspace, folders: Iterable[Path], *selection: str) -> None:
    """Run `colcon build` on a workspace, without a network.

    The build can write only to the workspace. `folders` are the folders of its packages, and `selection` contains
    colcon's options that select some of the packages.

    Raises:
        StudentError: the build failed, or `require_contained` rejects its files. The detail is the end of the output.
            If a limit stopped the build, the exception is a StoppedBuildError.
    """
    with workspace.private_folder() as folder:
        overlay = cmake_overlay.write_overlay(workspace.ros.prefixes, folder / "cmake-overlay")
        output, exit_reason, status = _run(workspace, overlay, colcon_command(workspace, folders, "build", *selection))
        output = output.replace(str(folder), "~")
    if exit_reason is not ExitReason.EXITED or status != 0:
        # Two gradings of the same submission use different folders for the workspace, which students know as ws.
        output = output.replace(str(workspace.root), "ws").replace(str(workspace.scratch), "~")
        error = StudentError if exit_reason is ExitReason.EXITED else StoppedBuildError
        raise error(
            Diagnosis(Kind.BUILD_FAILED, _build_failure(output, exit_reason), tail(readable_log(output), LOG_LINES))
        )
    require_contained(workspace.install)


def _run(workspace: Workspace, overlay: Path, command: list[str]) -> tuple[str, ExitReason | None, int | None]:
    spec = workspace.sandbox(BUILD)
    environment = {
        **spec.environment,
        "CMAKE_PREFIX_PATH": os.pathsep.join([str(overlay), spec.environment["CMAKE_PREFIX_PATH"]]),
        "COLCON_HOME": str(workspace.scratch),
        "MAKEFLAGS": f"-j{min(3, (os.cpu_count() or 1) + 1)}",
    }
    mounts = (*spec.mounts, Mount(RUNNER), Mount(workspace.root, writable=True), Mount(overlay))
    spec = replace(spec, workdir=workspace.root, mounts=mounts, environment=environment, network=False)
    with launch(command, spec, profile="colcon") as process:
        process.wait(BUILD.wall_seconds + 10)
        return process.output, process.exit_reason, process.returncode


def require_contained(install: Path) -> None:
    """Raise a StudentError if an install space is too large, or contains anything but files, folders and inner links.

    The install space is mounted for nodes, and a mount follows links. It is also copied, and in the copy a sparse file
    needs space for its full size.
    """
    if install.is_symlink():
        raise _not_contained(f"{install.name}, which leads out of the install space")
    if install.exists():
        try:
            list_tree(install, INSTALLED)
        except TreeError as error:
            raise _not_contained(str(error)) from None


def read_installed(install: Path) -> dict[Entry, bytes]:
    """Read an install space; raise a StudentError if `require_contained` rejects it or it cannot be read."""
    require_contained(install)
    try:
        return read_tree(install, INSTALLED) if install.exists() else {}
    except TreeError as error:
        raise _not_contained(str(error)) from None


def _not_contained(contents: str) -> StudentError:
    sentence = f"The build left {contents}: setup.py and CMakeLists.txt must install only plain files of the package."
    return StudentError(Diagnosis(Kind.BUILD_FAILED, sentence))


def _build_failure(output: str, exit_reason: ExitReason | None) -> str:
    if exit_reason is not ExitReason.EXITED and exit_reason is not None:
        reason = exit_reason.value.replace("_", " ")
        return f"colcon build was stopped ({reason}): a build should end within a minute or two."
    if "specified with --packages-up-to was not found" in output:
        return (
            "colcon does not find the package, because its package.xml breaks a rule of ROS: run colcon build and read "
            "the text after “Failed to parse ROS package manifest”."
        )
    # Before this line, colcon only reads src, and reports errors in packages that this build does not need.
    output = output[max(output.find("Starting >>> "), 0) :]
    first = first_error(output)
    return f"colcon build failed. The first error: {first}" if first else "colcon build failed."
