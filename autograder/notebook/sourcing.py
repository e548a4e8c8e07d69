"""`source` is the equivalent of `source install/setup.bash` for a notebook's running kernel.

The dynamic loader of a process searches only the folders that it knew when the process started. The libraries of a
sourced package are therefore loaded by their paths when Python first imports the package's compiled part.
"""

from __future__ import annotations

import ctypes
import hashlib
import importlib
import os
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType

from autograder.exceptions import UsageError
from autograder.notebook.notices import TROUBLE, Notice
from autograder.ros.environment import site_packages
from sim.grading import grading

KINDS = ("msg", "srv", "action")
NOT_WHILE_GRADING = "The workspace is built and used outside the notebook, after it has been executed."


def source(workspace: str | Path = "ws") -> Notice:
    """Let this kernel, and the programs that it starts, use a built workspace.

    Afterwards, the workspace's packages can be imported and found. Call it again after another build. A kernel that has
    loaded an interface cannot load a new version of it. In that case, the notice says so.

    Args:
        workspace: a colcon workspace after `colcon build`.

    Raises:
        UsageError: the workspace does not exist, or it was not built.
    """
    if grading():
        return Notice(NOT_WHILE_GRADING)
    prefixes = _prefixes(workspace)
    modules = [path for path in map(site_packages, prefixes) if path.is_dir()]
    _FINDER.prefixes |= {prefix.name: prefix for prefix in prefixes}
    if _FINDER not in sys.meta_path:
        sys.meta_path.insert(0, _FINDER)
    _put_first("AMENT_PREFIX_PATH", prefixes)
    _put_first("CMAKE_PREFIX_PATH", prefixes)
    _put_first("LD_LIBRARY_PATH", [prefix / "lib" for prefix in prefixes if (prefix / "lib").is_dir()])
    _put_first("PYTHONPATH", modules)
    sys.path[:] = [*map(str, modules), *(path for path in sys.path if Path(path) not in modules)]
    importlib.invalidate_caches()
    stale_packages = [prefix.name for prefix in prefixes if _FINDER.is_stale(prefix)]
    if stale_packages:
        sentence = (
            f"This kernel still uses the old {', '.join(stale_packages)}: choose Kernel, Restart, and run from the top."
        )
        return Notice(sentence, colour=TROUBLE)
    return Notice(f"This kernel can use {', '.join(prefix.name for prefix in prefixes)}.")


class _Libraries(MetaPathFinder):
    """Loads the libraries of a sourced package before its compiled part is imported. It never finds a module itself.

    Attributes:
        prefixes: the install prefix of each sourced package.
    """

    def __init__(self) -> None:
        self.prefixes: dict[str, Path] = {}
        # A fingerprint of each package's interfaces, as they were when its libraries were loaded.
        self._loaded_fingerprints: dict[str, str] = {}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, module = fullname.partition(".")
        is_loaded = package in self._loaded_fingerprints
        if package in self.prefixes and not is_loaded and module.startswith(f"{package}_s__"):
            self._loaded_fingerprints[package] = _fingerprint(self.prefixes[package])
            for library in sorted((self.prefixes[package] / "lib").glob("lib*.so")):
                self._load(library)
        return None

    def is_stale(self, prefix: Path) -> bool:
        """Return whether this process has loaded other interfaces of a package than those that are installed now."""
        return self._loaded_fingerprints.get(prefix.name, fingerprint := _fingerprint(prefix)) != fingerprint

    def _load(self, library: Path, required_by: tuple[str, ...] = ()) -> None:
        """Load a library, after the libraries of sourced packages that it needs.

        If the library cannot be loaded, the import that follows raises the error.
        """
        try:
            ctypes.CDLL(str(library))
        except OSError as error:
            missing = str(error).partition(":")[0]  # "libNAME.so: cannot open shared object file: ..."
            dependency = next((path for path in self._candidates(missing) if path.is_file()), None)
            if dependency is not None and missing not in required_by:
                self._load(dependency, (*required_by, missing))
                self._load(library, (*required_by, missing))

    def _candidates(self, name: str) -> list[Path]:
        return [] if "/" in name else [prefix / "lib" / name for prefix in self.prefixes.values()]


_FINDER = _Libraries()


def _prefixes(workspace: str | Path) -> list[Path]:
    """Return the install prefix of each package of a workspace."""
    root = Path(workspace).resolve()
    if not root.is_dir():
        raise UsageError(
            f"the folder {workspace} does not exist: run this in the assignment's folder, which contains ws"
        )
    install = root / "install"
    prefixes = sorted(path for path in install.iterdir() if (path / "share").is_dir()) if install.is_dir() else []
    if not prefixes:
        raise UsageError(f"{workspace} has not been built: run colcon build in {workspace}, and read its output")
    return prefixes


def _fingerprint(prefix: Path) -> str:
    """Return a digest of the names and texts of a package's installed interfaces."""
    digest = hashlib.sha256()
    for kind in KINDS:
        for path in sorted((prefix / "share" / prefix.name / kind).glob(f"*.{kind}")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


def _put_first(variable: str, paths: Sequence[Path]) -> None:
    others = [part for part in os.environ.get(variable, "").split(os.pathsep) if part and Path(part) not in paths]
    os.environ[variable] = os.pathsep.join([*map(str, paths), *others])
