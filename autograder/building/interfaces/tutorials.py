"""Installs the interface packages of ROS's tutorials, which have no wheels.

They are built from `tutorials.yaml` into the prefix of this environment, for Python programs only: they do not contain
the files that CMake packages need. Set-up runs this module. For a sourced ROS 2, which has the real packages, it
does nothing.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

import yaml

from autograder.building.interfaces.cache import Cache
from autograder.building.interfaces.definition_reader import read
from autograder.building.interfaces.definitions import InterfaceError
from autograder.building.interfaces.prefix import build
from autograder.ros import RosError, find

DEFINITIONS = Path(__file__).with_name("tutorials.yaml")
FOLDERS = ("share", "lib", "include")


def packages() -> dict[str, dict[str, str]]:
    """Return the definitions of each package in the form that `build` accepts: their texts by path."""
    definitions: dict[str, dict[str, str]] = yaml.safe_load(DEFINITIONS.read_text(encoding="utf-8"))
    return definitions


def missing(prefix: Path) -> dict[str, dict[str, str]]:
    """Return those of `packages()` that `prefix` does not contain, or contains with other definitions."""
    return {name: files for name, files in packages().items() if not _is_installed(prefix, name, files)}


def install(prefix: Path) -> list[str]:
    """Build the packages that are missing in the virtual environment `prefix`; return their names."""
    packages_to_build = missing(prefix)
    with tempfile.TemporaryDirectory() as scratch:
        for name, files in packages_to_build.items():
            built_prefix = build(name, files, cache=Cache(Path(scratch)))
            for folder in FOLDERS:
                shutil.copytree(built_prefix / folder, prefix / folder, dirs_exist_ok=True, copy_function=_replace)
    return list(packages_to_build)


def _is_installed(prefix: Path, package: str, files: dict[str, str]) -> bool:
    share = prefix / "share" / package
    texts = {share / definition.path: definition.text for definition in read(package, files)}
    return all(path.is_file() and path.read_text(encoding="utf-8") == text for path, text in texts.items())


def _replace(source: str, target: str) -> None:
    """Replace the target by a copy in one step, because the file of a library that a process uses must not change."""
    new = Path(f"{target}.new")
    shutil.copy2(source, new)
    new.replace(target)


def main() -> int:
    """Install the packages in this environment. Without a compiler, print how to do that later, and succeed."""
    prefix = Path(sys.prefix)
    try:
        if find().kind != "wheels" or not (missing_packages := missing(prefix)):
            return 0
        names = ", ".join(missing_packages)
        if shutil.which("g++") is None:
            command = f"{sys.executable} -m autograder.building.interfaces.tutorials"
            print(f"g++ is missing, so {names} are not installed; once it is there, run {command}")
            return 0
        print(f"building {names}", flush=True)
        install(prefix)
    except (InterfaceError, RosError) as error:
        print(f"The interface packages of ROS's tutorials cannot be installed: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
