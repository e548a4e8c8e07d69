"""Making a built interface package importable in this process."""

from __future__ import annotations

import importlib
import json
import os
import sys
from pathlib import Path
from types import ModuleType

from autograder.interfaces.compile import site
from autograder.interfaces.exceptions import AlreadyLoadedError
from autograder.interfaces.prefix import RECIPE

_loaded: dict[str, Path] = {}


def load(prefix: Path) -> ModuleType:
    """Import the package of a prefix that `build` returned, and those that it uses.

    Raises:
        AlreadyLoadedError: this process has another package of that name.
    """
    recipe = json.loads((prefix / RECIPE).read_text())
    package = recipe["package"]
    if _loaded.get(package) == prefix:
        return sys.modules[package]
    if package in _loaded or package in sys.modules:
        there = _loaded.get(package) or sys.modules[package].__file__
        raise AlreadyLoadedError(
            f"{package} is loaded from {there} already: a process can hold one version of it, start another process"
        )
    for underlay in recipe["underlays"]:
        load(Path(underlay))
    sys.path.insert(0, str(site(prefix)))
    found = os.environ.get("AMENT_PREFIX_PATH", "")
    os.environ["AMENT_PREFIX_PATH"] = os.pathsep.join(filter(None, [str(prefix), found]))
    importlib.invalidate_caches()
    module = importlib.import_module(package)
    # The extension module brings the libraries with it; rcl then finds them, loaded, by their names.
    importlib.import_module(f"{package}.{package}_s__rosidl_typesupport_c")
    for kind in sorted({path.split("/")[0] for path in recipe["texts"]}):
        importlib.import_module(f"{package}.{kind}")
    _loaded[package] = prefix
    return module
