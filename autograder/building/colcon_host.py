"""colcon, whose Python children are forked from it.

    python colcon_host.py ARGUMENTS-OF-COLCON

To build one Python package, colcon starts Python three times for its setup.py, and most of what those do is to import
setuptools, which colcon has imported, too. Here they are forked from colcon's process, and become what a new
interpreter would be: the same command line, environment, module path, sitecustomize and streams. The pytest of
`colcon test` is forked from a nursery, if pytest came from the zygote. Whatever else colcon starts, and every child
where this Python's `subprocess` is another than this knows, is started as ever.

It runs inside the sandbox of a build, as colcon does, and is no less the student's to harm.
"""

from __future__ import annotations

import atexit
import importlib
import logging
import os
import signal
import sys
import sysconfig
import traceback
import warnings
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, NoReturn

sys.path[0] = str(Path(__file__).parents[1] / "sandbox" / "zygote_host")
if TYPE_CHECKING:
    from autograder.sandbox.zygote_host import children, nursery
else:
    import children
    import nursery
nursery.forget_these()
sys.path[0] = str(Path(sys.executable).parent)  # where colcon's own script is, and no module of this folder
_GIVEN = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
_BASE = [path for path in sys.path[1:] if path not in _GIVEN]
_VENDORED = Path(str(importlib.import_module("setuptools").__file__)).parent / "_vendor"  # which it adds to the path


def _fork(args: Any, given: dict[str, Any]) -> int:
    """Fork a setup.py; return its process id, 0 for any other command."""
    if not _is_setup(args) or given["shell"]:
        return 0
    sys.stdout.flush()
    sys.stderr.flush()
    pid = os.fork()
    if pid == 0:
        _become([os.fsdecode(word) for word in args], children.streams(given), given["cwd"], given["env"])
    return pid


def _is_setup(args: Sequence[Any]) -> bool:
    words = [] if isinstance(args, str | bytes) else [os.fsdecode(word) for word in args]
    return words[:1] == [sys.executable] and ("setup.py" in words or (words[1:2] == ["-c"] and "run_setup" in words[2]))


def _become(
    command: list[str], streams: tuple[int, int, int], cwd: str | None, environment: Mapping[str, str] | None
) -> NoReturn:
    """Be a Python that was started for `command`, to its end."""
    status = 1
    try:
        _take(streams)
        os.chdir(cwd or ".")
        if environment is not None:
            os.environ.clear()
            os.environ.update(environment)
        _run(command)
        status = 0
    except SystemExit as end:
        if not isinstance(end.code, int | None):
            print(end.code, file=sys.stderr)
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException as error:
        own = error.__traceback__ and error.__traceback__.tb_next  # this frame and the next are no part of the program
        traceback.print_exception(type(error), error, own and own.tb_next)
    finally:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _take(streams: tuple[int, int, int]) -> None:
    """Make the descriptors the standard ones, and close all others; end what colcon does about signals and logs."""
    signal.set_wakeup_fd(-1)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for heard in (signal.SIGTERM, signal.SIGCHLD):
        signal.signal(heard, signal.SIG_DFL)
    atexit._clear()
    logging.root.handlers.clear()
    logging.root.setLevel(logging.WARNING)
    for number, descriptor in enumerate(streams):
        if descriptor not in (-1, number):
            os.dup2(descriptor, number)
    os.closerange(3, os.sysconf("SC_OPEN_MAX"))
    for name, number in (("stdout", 1), ("stderr", 2)):
        like = getattr(sys, f"__{name}__")
        stream = open(number, "w", encoding=like.encoding, errors=like.errors, closefd=False)  # noqa: SIM115
        setattr(sys, name, stream)


def _run(command: list[str]) -> None:
    words = command[1:]
    while words[0] == "-W":
        action, _, message = words[1].partition(":")
        warnings.filterwarnings(action, message)  # type: ignore[arg-type]
        words = words[2:]
    script = Path(words[0]).absolute() if words[0] != "-c" else None
    code = script.read_bytes() if script else words[1]
    sys.argv[:] = words if script else ["-c", *words[2:]]
    given = os.environ.get("PYTHONPATH")
    modules = [str(Path(part).absolute()) for part in given.split(os.pathsep)] if given else []
    sys.path[:] = [*modules, *_BASE]
    sys.path_importer_cache.clear()
    sys.modules.pop("sitecustomize", None)
    if any(Path(folder, "sitecustomize.py").exists() for folder in modules):
        importlib.import_module("sitecustomize")
        importlib.reload(sysconfig)  # it has noted down the prefix that colcon's sitecustomize takes away
    # What stands beside the script is found from now on: no sitecustomize is looked for there.
    sys.path[:] = [str(script.parent) if script else "", *sys.path, *([str(_VENDORED)] * _VENDORED.is_dir())]
    # setuptools asks nine times in a run, and each time all packages' metadata are read.
    everything = lru_cache(metadata.entry_points)
    metadata.entry_points = lambda **chosen: everything().select(**chosen)  # type: ignore[assignment]
    main = sys.modules["__main__"] = ModuleType("__main__")
    main.__dict__.update(__builtins__=__builtins__, __annotations__={})
    if script:
        main.__dict__.update(__file__=str(script), __cached__=None)
    exec(compile(code, str(script or "<string>"), "exec"), main.__dict__)


def open_nursery() -> Any:
    """Let pytest be forked, and what that starts; in their processes, return what is to be run."""
    own = [name for name in sys.modules if name.partition("_")[0] == "colcon" or name == "autograder"]
    return nursery.open_here(forget=own, modules=("pytest",))


def main() -> int | str | None:
    """Run colcon."""
    children.made_by(_fork)
    sys.argv[0] = "colcon"
    status: int | str | None = importlib.import_module("colcon_core.command").main()
    return status


if __name__ == "__main__":
    if program := open_nursery() if "pytest" in sys.modules else None:
        exec(*program)
    else:
        sys.exit(main())
