"""Compares the imports of a package's sources with the dependencies in package.xml. Sources are parsed and never run.

rosdep installs the packages in package.xml before a build, so an undeclared import works only on its author's machine.
A file that cannot be searched could contain any import, so it fails the check.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from autograder.probes.files import plain_files, read_limited, search_python
from autograder.probes.manifest import Manifest
from autograder.suite import CheckFailed

MAX_FILES = 300
MAX_BYTES = 256 * 1024
MAX_ALL_BYTES = 4 * 1024 * 1024  # bytes of all parsed files of a package
# What tools leave in any folder, and colcon in the folder in which it runs. Elsewhere, a module can be called log.
SKIPPED_FOLDERS = frozenset({"/build", "/install", "/log", "__pycache__", ".ipynb_checkpoints", ".pytest_cache"})

# The rosdep keys of common modules that are not ROS packages. A ROS package's key is its own name.
KEYS = {
    "PIL": "python3-pil",
    "_pytest": "python3-pytest",
    "cv2": "python3-opencv",
    "matplotlib": "python3-matplotlib",
    "mpl_toolkits": "python3-matplotlib",
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
SETUP_FILE = "setup.py"  # not searched, because colcon provides its imports


@dataclass(frozen=True)
class Import:
    """An external top-level module, such as `numpy`, and the files of a package that import it."""

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
        within: the folders of the package whose files are read; all if empty.
        without: the folders whose files are not read.

    Raises:
        CheckFailed: a file is too large or is not Python, or there are too many files or bytes in all.
    """
    first_party = {path.parent.name for path in package.glob("*/__init__.py")} | {package.name}
    by_module: dict[str, list[str]] = {}
    remaining = MAX_ALL_BYTES
    for file in plain_files(package, MAX_FILES, skip=SKIPPED_FOLDERS, suffix=".py"):
        path = package / file
        top = file.parts[0]
        if str(file) == SETUP_FILE or (within and top not in within) or top in without:
            continue
        # A test can import the modules beside it, because pytest puts their folder on the path.
        siblings = {sibling.stem for sibling in path.parent.glob("*.py")} if top == "test" else set()
        name = f"{package.name}/{file}"
        source = read_limited(path, MAX_BYTES, name)
        remaining -= len(source)
        if remaining < 0:
            raise CheckFailed(
                f"{package.name} contains more than {MAX_ALL_BYTES // 2**20} MiB of Python, which is too much "
                "to search for imports: keep generated files out of the package."
            )
        for module in modules(source, name) - first_party - siblings - sys.stdlib_module_names:
            by_module.setdefault(module, []).append(str(file))
    return tuple(Import(module, tuple(files)) for module, files in sorted(by_module.items()))


@lru_cache(MAX_FILES)  # several checks read the same files
def modules(source: bytes, name: str) -> frozenset[str]:
    """Return the names of the top-level modules that the source of a file imports.

    Raises:
        CheckFailed: it is too large or is not Python. The message calls it `name`.
    """
    names: set[str] = set()
    for node in ast.walk(search_python(source, MAX_BYTES, name)):
        if isinstance(node, ast.Import):
            names.update(alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.split(".")[0])
    return frozenset(names)


def undeclared(imports: Collection[Import], declared: Collection[str]) -> tuple[Import, ...]:
    """Return the imports that no declared name covers."""
    return tuple(item for item in imports if not set(item.keys) & set(declared))


def missing(package: Path, manifest: Manifest) -> Mapping[str, tuple[Import, ...]]:
    """Return the undeclared imports of a package, by the kind of dependency that would declare them.

    `exec` is for imports in modules and launch files. `test` is for imports that only files in test/ need, which may
    also be declared as `exec` dependencies.
    """
    runtime = undeclared(imported(package, without=("test",)), manifest.needs("exec"))
    tests = undeclared(imported(package, within=("test",)), manifest.needs("exec", "test"))
    runtime_modules = {item.module for item in runtime}
    return {"exec": runtime, "test": tuple(item for item in tests if item.module not in runtime_modules)}


def describe(imports: Collection[Import]) -> str:
    """List imports, each with a file that contains it and the name to declare."""
    return "; ".join(f"{item.files[0]} imports {item.module}{_key_suffix(item)}" for item in imports)


def _key_suffix(item: Import) -> str:
    return f" ({item.keys[0]})" if item.keys[0] != item.module else ""
