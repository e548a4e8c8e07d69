"""Installs the interface packages of ROS's own tutorials beside the wheels, which lack them.

They are built from `tutorials.yaml` into the prefix of this environment, for Python programs: they lack what a CMake
package that uses them would need. Set-up runs this module. A sourced ROS 2 has the real packages, and nothing happens.
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
INSTALLED = ("share", "lib", "include")


def packages() -> dict[str, dict[str, str]]:
    """Return each package's definitions, text by path, as `build` takes them."""
    definitions: dict[str, dict[str, str]] = yaml.safe_load(DEFINITIONS.read_text(encoding="utf-8"))
    return definitions


def missing(prefix: Path) -> dict[str, dict[str, str]]:
    """Return the packages that are not in `prefix`, or are there with other definitions, as `packages` does."""
    return {name: files for name, files in packages().items() if not _installed(prefix, name, files)}


def install(prefix: Path) -> list[str]:
    """Build the packages that are missing in the virtual environment `prefix`; return their names."""
    lacking = missing(prefix)
    with tempfile.TemporaryDirectory() as scratch:
        for name, files in lacking.items():
            built = build(name, files, cache=Cache(Path(scratch)))
            for folder in INSTALLED:
                shutil.copytree(built / folder, prefix / folder, dirs_exist_ok=True, copy_function=_replace)
    return list(lacking)


def _installed(prefix: Path, package: str, files: dict[str, str]) -> bool:
    texts = {prefix / "share" / package / each.path: each.text for each in read(package, files)}
    return all(path.is_file() and path.read_text(encoding="utf-8") == text for path, text in texts.items())


def _replace(source: str, target: str) -> None:
    """Copy a file to a new one in the target's place: a library that a process has loaded must not change."""
    new = Path(f"{target}.new")
    shutil.copy2(source, new)
    new.replace(target)


def main() -> int:
    """Install them into this environment; without a compiler, say how to do that later: much needs neither."""
    prefix = Path(sys.prefix)
    try:
        if find().kind != "wheels" or not (lacking := missing(prefix)):
            return 0
        names = ", ".join(lacking)
        if shutil.which("g++") is None:
            again = f"{sys.executable} -m autograder.building.interfaces.tutorials"
            print(f"g++ is missing, so {names} are not installed; once it is there, run {again}")
            return 0
        print(f"building {names}", flush=True)
        install(prefix)
    except (InterfaceError, RosError) as error:
        print(f"The interface packages of ROS's tutorials cannot be installed: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
