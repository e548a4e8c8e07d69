"""A package grows: new files are laid into a copy of it, and its setup.py, as it is, has to install them."""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace

from autograder.building.build import build
from autograder.checks.ch01_package_structure.support import contract
from autograder.checks.ch01_package_structure.support.assertions import source_of
from autograder.harness import Workspace
from autograder.probes.installed import Installed, look


@dataclass(frozen=True)
class Grown:
    """What was installed of the grown copy, and what of it was new.

    Attributes:
        installed: what colcon installed of it.
        launch: the new launch file.
        config: the new configuration.
        module: the new module, in a subpackage of its own.
    """

    installed: Installed
    launch: str
    config: str
    module: str


def grow(workspace: Workspace, word: str) -> Grown:
    """Copy the student's package, add files to it and build the copy.

    Args:
        workspace: the built workspace; it is left as it is.
        word: the name of the new files, one that no list written by hand holds.

    Raises:
        StudentError: the copy does not build.
    """
    name = contract.SQUARE_DANCE
    copy = replace(workspace, root=workspace.root.parent / "grown")
    folder = copy.root / "src" / name
    shutil.copytree(source_of(workspace, name), folder)
    grown = Grown(
        look(copy.install, name),
        launch=f"launch/{word}.launch.py",
        config=f"config/{word}.yaml",
        module=f"{name}.{word}.steps",
    )
    for file in (
        grown.launch,
        grown.config,
        f"{name}/{word}/__init__.py",
        f"{name}/{word}/steps.py",
        "test/__init__.py",
        f"test/test_{word}.py",
    ):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text("")
    build(copy, (name,))
    return replace(grown, installed=look(copy.install, name))
