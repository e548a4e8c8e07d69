"""Making a forked interpreter like one that was started for a program."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any


def become(
    command: Sequence[str], environment: Mapping[str, str], base: Mapping[str, bool], first: str | None = None
) -> tuple[CodeType, dict[str, Any]]:
    """Make this interpreter like one that was started for a program; return the program's code and its namespace.

    Args:
        command: the program's script and its arguments.
        environment: all its environment variables.
        base: where Python finds modules without any PYTHONPATH, and whether that is there outside the sandbox.
        first: where it looks before that, if not in the script's folder.
    """
    before = os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep)
    os.environ.clear()
    ctypes.CDLL(None).clearenv()  # libraries that were loaded have set some, of which `os` does not know
    os.environ.update(environment)
    script = Path(command[0])
    file, folder = (script / "__main__.py", script) if script.is_dir() else (script, script.parent)
    modules = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    if _shadowed(
        [first, *modules] if first else modules
    ):  # such a program would have another module than the one that is loaded
        os.execve(sys.executable, [sys.executable, *command], os.environ)
    hidden = {path for path, there in base.items() if there and not Path(path).exists()}
    sys.path[:] = [first or str(folder), *modules, *(path for path in base if path not in hidden)]
    sys.path_importer_cache.clear()  # it knows the folders of the outside
    sys.argv[:] = command
    sys.orig_argv[:] = [sys.executable, *command]
    _load([part for part in os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep) if part not in before])
    main = sys.modules["__main__"] = ModuleType("__main__")
    main.__dict__.update(__file__=str(file), __builtins__=__builtins__)
    return compile(file.read_bytes(), str(file), "exec"), main.__dict__


def _shadowed(folders: Sequence[str]) -> bool:
    """Return whether a folder has a module of its own that is called as one that is loaded from elsewhere."""
    ready = (name for finder in sys.meta_path for name in getattr(finder, "ready", ()))
    loaded = {name.partition(".")[0] for name in (*sys.modules, *ready)}
    return any(
        (name := entry.name.partition(".")[0]) in loaded and _is_module(entry) and not _is_from(folder, name)
        for folder in folders
        if Path(folder).is_dir()
        for entry in Path(folder).iterdir()
    )


def _is_module(entry: Path) -> bool:
    return entry.suffix in (".py", ".pyc", ".so") or (entry / "__init__.py").exists()


def _is_from(folder: str, name: str) -> bool:
    spec = getattr(sys.modules.get(name), "__spec__", None)
    return spec is not None and Path(spec.origin or "").is_relative_to(folder)


def _load(folders: Sequence[str]) -> None:
    """Load the libraries of the sandbox's own packages.

    The dynamic linker has read LD_LIBRARY_PATH when this process was started, and looks nowhere else. It does take what
    is loaded already. A library that needs another one of them is tried again.
    """
    waiting = [path for folder in folders if folder for path in sorted(Path(folder).glob("lib*.so"))]
    while waiting:
        left = [path for path in waiting if not _loads(path)]
        if len(left) == len(waiting):
            return
        waiting = left


def _loads(path: Path) -> bool:
    try:
        ctypes.CDLL(str(path))
    except OSError:
        return False
    return True
