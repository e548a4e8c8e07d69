"""A package grows: new files are laid into a copy of it, and its setup.py, as it is, has to install them."""

from __future__ import annotations

from dataclasses import dataclass

from autograder.checks.ch01_package_structure.support import contract
from autograder.harness import Workspace
from autograder.probes.added_files import install_with
from autograder.probes.installed import Installed


@dataclass(frozen=True)
class Grown:
    """What was installed of the grown copy, and what of it was new.

    Attributes:
        installed: what colcon installed of it.
        launch: the new launch file.
        config: the new configuration.
        modules: the new modules, each in a subpackage of its own; one is deeper, and has "test" within its name.
    """

    installed: Installed
    launch: str
    config: str
    modules: tuple[str, ...]


def grow(workspace: Workspace, word: str) -> Grown:
    """Copy the student's package, add files to it and build the copy.

    Args:
        workspace: the built workspace; it is left as it is.
        word: the name of the new files, one that no list written by hand holds.

    Raises:
        StudentError: the copy does not build.
    """
    name = contract.SQUARE_DANCE
    launch, config, test = f"launch/{word}.launch.py", f"config/{word}.yaml", f"test/test_{word}.py"
    folders = f"{name}/{word}", f"{name}/utils/contest_{word}"
    code = [f"{folder}/{file}.py" for folder in folders for file in ("__init__", "steps")]
    return Grown(
        install_with(workspace, name, (launch, config, test, "test/__init__.py", *code)),
        launch,
        config,
        tuple(f"{folder.replace('/', '.')}.steps" for folder in folders),
    )
