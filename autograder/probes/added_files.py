"""Installs a package with added files, which a handwritten list of names in setup.py would miss."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from dataclasses import replace

from autograder.building.build import build
from autograder.probes.installed import Installed, inspect_package
from autograder.run.workspace import Workspace
from autograder.submission.packages import find_packages
from autograder.submission.reading import reading


def install_with(workspace: Workspace, package: str, files: Iterable[str]) -> Installed:
    """Copy a package, add empty files to the copy, build it, and return what was installed.

    Args:
        workspace: the built workspace, which is not changed.
        package: the package's name.
        files: paths below the package's folder.

    Raises:
        StudentError: the copy does not build.
    """
    copy = replace(workspace, root=workspace.root.parent / "grown")
    folder = copy.root / "src" / package
    with reading(f"The folder of {package}"):
        shutil.copytree(find_packages(workspace.root / "src")[0][package], folder, symlinks=True)
    for file in files:
        with reading(f"{package}/{file}", advice="The check adds a file with this name: rename yours."):
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_text("")
    build(copy, (package,))
    return inspect_package(copy.install, package)
