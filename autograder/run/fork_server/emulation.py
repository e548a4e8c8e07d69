"""Turns a forked interpreter into that of another program, as if execve(2) had started Python anew."""

from __future__ import annotations

import builtins
import ctypes
import importlib
import os
import re
import sys
import sysconfig
import warnings
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import CodeType, ModuleType, TracebackType
from typing import Any

Program = tuple[CodeType, dict[str, Any]]

_ARG_START = 45  # index among the fields of /proc/self/stat after the name; arg_end is the next, see proc_pid_stat(5)


def emulate_start(
    command: Sequence[str], environment: Mapping[str, str], base_paths: Mapping[str, bool], **extra_globals: Any
) -> Program:
    """Make this interpreter like one that was started with a command line. Return its code and its globals.

    Args:
        command: the words after `python`: `-W FILTER` any number of times, a script or `-c CODE`, and its arguments.
        environment: all environment variables.
        base_paths: the module paths without PYTHONPATH, and whether each exists outside the sandbox.
        extra_globals: additional globals of the program.
    """
    code: CodeType | None = None

    def print_exception(kind: type[BaseException], error: BaseException, tb: TracebackType | None) -> None:
        while tb and tb.tb_frame.f_code is not code:  # skip the callers of the program
            tb = tb.tb_next
        sys.__excepthook__(kind, error.with_traceback(tb), tb)

    sys.excepthook = print_exception
    loaded_folders = os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep)
    os.environ.clear()
    ctypes.CDLL(None).clearenv()  # including variables that libraries have set, which `os` does not know
    os.environ.update(environment)
    words = [*command]
    while words[0] == "-W":
        action, _, message = words[1].partition(":")
        warnings.filterwarnings(action, message)  # type: ignore[arg-type]
        words = words[2:]
    if words[0] == "-c":
        file, folder, source = None, "", words.pop(1).encode()
    else:
        path = Path(words[0]).absolute()
        file, folder = (path / "__main__.py", str(path)) if path.is_dir() else (path, str(path.parent))
        source = file.read_bytes()
    _find_modules(command, folder, base_paths)
    if numpy_random := sys.modules.get("numpy.random"):
        numpy_random.seed()  # its global generator; Python seeds `random` again at each fork
    set_command_line([sys.executable, *command])
    sys.argv[:] = words
    sys.orig_argv[:] = [sys.executable, *command]
    _load_libraries(
        part for part in os.environ.get("LD_LIBRARY_PATH", "").split(os.pathsep) if part not in loaded_folders
    )
    main = sys.modules["__main__"] = ModuleType("__main__")
    main.__dict__.update(__builtins__=builtins, __annotations__={}, **extra_globals)
    if file:
        main.__dict__.update(__file__=str(file), __cached__=None)
    code = compile(source, str(file or "<string>"), "exec", dont_inherit=True)
    return code, main.__dict__


def unload_packages(words: Iterable[str]) -> None:
    """Unload the modules of packages whose names begin with one of these words."""
    for name in [name for name in sys.modules if re.split("[._]", name)[0] in words]:
        del sys.modules[name]


def set_command_line(words: Sequence[str]) -> None:
    """Set /proc/self/cmdline to `words`, cut to the space that exists."""
    start, end = map(int, Path("/proc/self/stat").read_text().rpartition(")")[2].split()[_ARG_START:][:2])
    text = b"".join(os.fsencode(word) + b"\0" for word in words)[: end - start - 1]
    ctypes.memmove(start, text.ljust(end - start, b"\0"), end - start)


def _find_modules(command: Sequence[str], script_folder: str, base_paths: Mapping[str, bool]) -> None:
    """Set `sys.path` from the command line and PYTHONPATH.

    If the program would import another module instead of a loaded one, it is started without forking.
    """
    python_path = os.environ.get("PYTHONPATH")  # an empty part means the working folder
    modules = (
        [*dict.fromkeys(str(Path(part).absolute()) for part in python_path.split(os.pathsep))] if python_path else []
    )
    sys.modules.pop("sitecustomize", None)
    if _shadow_loaded_modules(modules):
        os.execve(sys.executable, [sys.executable, *command], os.environ)
    sys.path[:] = [*modules, *(path for path, exists in base_paths.items() if not exists or Path(path).exists())]
    sys.path_importer_cache.clear()  # it describes folders outside the sandbox
    if any(Path(module, "sitecustomize.py").exists() for module in modules):
        importlib.import_module("sitecustomize")
        importlib.reload(sysconfig)  # colcon's sitecustomize changes the prefix
    sys.path.insert(0, script_folder)


def _shadow_loaded_modules(folders: Sequence[str]) -> bool:
    """Return whether one of the folders contains a module that has the name of one loaded from elsewhere."""
    loaded_names = {name.partition(".")[0] for name in sys.modules}
    return any(
        (name := entry.name.partition(".")[0]) in loaded_names and _is_module(entry) and not _is_from(folder, name)
        for folder in folders
        if Path(folder).is_dir()
        for entry in Path(folder).iterdir()
    )


def _is_module(entry: Path) -> bool:
    return entry.suffix in (".py", ".pyc", ".so") or (entry / "__init__.py").exists()


def _is_from(folder: str, name: str) -> bool:
    spec = getattr(sys.modules.get(name), "__spec__", None)
    return spec is not None and Path(spec.origin or "").is_relative_to(folder)


def _load_libraries(folders: Iterable[str]) -> None:
    """Load the libraries of the sandbox's own packages.

    The dynamic linker read LD_LIBRARY_PATH when the server was started, and does not search other folders. But it uses
    libraries that are already loaded. So if a library cannot be loaded yet, it is tried again after the others.
    """
    pending = [path for folder in folders if folder for path in sorted(Path(folder).glob("lib*.so"))]
    while pending:
        failed_paths = [path for path in pending if not _can_load(path)]
        if len(failed_paths) == len(pending):
            return
        pending = failed_paths


def _can_load(path: Path) -> bool:
    try:
        ctypes.CDLL(str(path))
    except OSError:
        return False
    return True
