"""The imports of a package's sources, and whether package.xml declares them. Sources are parsed and never run.

rosdep installs the packages in package.xml before a build, so an undeclared import works only on its author's machine.
Files that are too large or not Python, or exceed the maximum number, are left out.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from autograder.probes.files import parse_python, plain_files, read_plain
from autograder.probes.manifest import Manifest
from autograder.suite import CheckFailed

MAX_FILES = 300
MAX_BYTES = 256 * 1024
MAX_ALL_BYTES = 4 * 1024 * 1024  # of all files of a package that are parsed
LEFT_OUT = frozenset({"build", "install", "log", "__pycache__", ".ipynb_checkpoints", ".pytest_cache"})

# The rosdep keys of common modules that are not ROS packages. A ROS package's key is its own name.
KEYS = {
    "PIL": "python3-pil",
    "cv2": "python3-opencv",
    "matplotlib": "python3-matplotlib",
    "networkx": "python3-networkx",
    "numpy": "python3-numpy",
    "pandas": "python3-pandas",
    "psutil": "python3-psutil",
    "pytest": "python3-pytest",
    "requests": "python3-requests",
    "scipy": "python3-scipy",
    "serial": "python3-serial",
    "setuptools": "python3-setuptools",
    "shapely": "python3-shapely",
    "sympy": "python3-sympy",
    "yaml": "python3-yaml",
}
SET_UP = "setup.py"  # colcon's own set-up provides its imports


@dataclass(frozen=True)
class Import:
    """A top-level module, such as `numpy`, that files of a package import from outside."""

    module: str
    files: tuple[str, ...]

    @property
    def keys(self) -> tuple[str, ...]:
        """The names in package.xml that would declare it, the likeliest first."""
        if self.module in KEYS:
            return (KEYS[self.module],)
        return self.module, f"python3-{self.module.lower().replace('_', '-')}"


def imported(package: Path, *, within: Collection[str] = (), without: Collection[str] = ()) -> tuple[Import, ...]:
    """Return the imports in the Python files of a package, without the standard library and its own modules.

    Args:
        package: the package's folder.
        within: only files below these folders of it; all if none is named.
        without: no files below these.

    Raises:
        CheckFailed: these files hold more than `MAX_ALL_BYTES`.
    """
    own = {path.parent.name for path in package.glob("*/__init__.py")} | {package.name}
    by_module: dict[str, list[str]] = {}
    left = MAX_ALL_BYTES
    for where in plain_files(package, MAX_FILES, left_out=LEFT_OUT, suffix=".py"):
        path = package / where
        top = where.parts[0]
        if str(where) == SET_UP or (within and top not in within) or top in without:
            continue
        # A test imports its neighbours, which pytest puts on the path.
        beside = {sibling.stem for sibling in path.parent.glob("*.py")} if top == "test" else set()
        text = _text(path)
        left -= len(text)
        if left < 0:
            raise CheckFailed(
                f"{package.name} holds more than {MAX_ALL_BYTES // 2**20} MiB of Python, too much to look for its "
                "imports: keep generated files out of the package."
            )
        for module in modules(text) - own - beside - sys.stdlib_module_names:
            by_module.setdefault(module, []).append(str(where))
    return tuple(Import(module, tuple(files)) for module, files in sorted(by_module.items()))


@lru_cache(MAX_FILES)  # several checks look at the same files
def modules(text: str) -> frozenset[str]:
    """Return the top-level names that a module's text imports, or none if it is not Python."""
    names: set[str] = set()
    for node in ast.walk(parse_python(text) or ast.Module([], [])):
        if isinstance(node, ast.Import):
            names.update(alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
    return frozenset(names)


def undeclared(imports: Collection[Import], declared: Collection[str]) -> tuple[Import, ...]:
    """Return the imports that no declared name covers."""
    return tuple(each for each in imports if not set(each.keys) & set(declared))


def missing(package: Path, manifest: Manifest) -> Mapping[str, tuple[Import, ...]]:
    """Return the undeclared imports of a package, by the kind of dependency that would declare them.

    `exec` is for the modules and launch files. `test` is for what only test/ imports; there, `exec` counts, too.
    """
    runs = undeclared(imported(package, without=("test",)), manifest.needs("exec"))
    tests = undeclared(imported(package, within=("test",)), manifest.needs("exec", "test"))
    known = {each.module for each in runs}
    return {"exec": runs, "test": tuple(each for each in tests if each.module not in known)}


def describe(imports: Collection[Import]) -> str:
    """List imports with their places and the declarations that they need."""
    return "; ".join(f"{each.files[0]} imports {each.module}{_called(each)}" for each in imports)


def _called(one: Import) -> str:
    return f" ({one.keys[0]})" if one.keys[0] != one.module else ""


def _text(path: Path) -> str:
    return (read_plain(path, MAX_BYTES) or b"").decode(errors="replace")
