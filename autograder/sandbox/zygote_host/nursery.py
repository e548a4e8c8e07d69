"""Python programs that a forked program starts, forked as well.

    if program := nursery.open_here():
        exec(*program)  # the process of one that was started

What `ros2 launch` starts are ROS programs, each of which would import all that the launch was forked with. The launch
must not fork them itself: it is about to have threads, and things of its own in memory. So before it does anything it
forks the nursery, which stays as it is, and forks for each command that `subprocess` is given. Python scripts with this
interpreter in their first line are forked, anything else is started as ever, and so is everything where this Python's
`subprocess` is another than this knows.

A program's parent is the one who asked: the nursery's child makes it and ends, and then it is adopted (`prctl(2)`,
PR_SET_CHILD_SUBREAPER). All of it runs inside the sandbox, and is no less the student's to harm.
"""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import signal
import socket
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from autograder.sandbox.zygote_host import becoming, children
else:
    import becoming
    import children

Program = tuple[Any, dict[str, Any]]

_PR_SET_CHILD_SUBREAPER = 36
_MAX_ORDER = 1024 * 1024  # bytes
_ARG_START, _ARG_END = 45, 46  # among the fields of /proc/self/stat behind the name, proc_pid_stat(5)
_PLAIN: dict[str, Any] = {"preexec_fn": None, "close_fds": True, "shell": False, "restore_signals": True, "umask": -1}
_PLAIN |= dict.fromkeys(("executable", "gid", "gids", "uid"))


def open_here(forget: Sequence[str] = (), modules: Sequence[str] = ()) -> Program | None:
    """Fork the nursery of this process, which from now on has its Python programs forked there.

    Call it while the process has one thread, and has read nothing of the student's.

    Args:
        forget: top-level modules that this process has imported and its programs have not.
        modules: what is forked when it is run by `python -m`; such a program gets a nursery of its own.

    Returns:
        None here; in the process of a program what that is to run: its code, and the namespace for it.
    """
    if not children.KNOWN:
        return None
    forget_these()
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    line, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    sys.stdout.flush()
    if os.fork() == 0:
        line.close()
        for name in [name for name in sys.modules if name.partition(".")[0] in forget]:
            del sys.modules[name]
        return _serve(theirs)
    theirs.close()
    children.made_by(_Orders(line, modules).make)
    return None


def forget_these() -> None:
    """Let nobody else import the modules of this folder: a student's may be called the same."""
    for name in ("becoming", "children", "nursery"):
        sys.modules.pop(name, None)


def be_called(words: Sequence[str]) -> None:
    """Let /proc/self/cmdline say `words`, as much of them as there is room for."""
    start, end = map(int, Path("/proc/self/stat").read_text().rpartition(")")[2].split()[_ARG_START:][:2])
    text = b"".join(os.fsencode(word) + b"\0" for word in words)[: end - start - 1]
    ctypes.memmove(start, text.ljust(end - start, b"\0"), end - start)


class _Orders:
    """The line to a nursery, as `subprocess` uses it."""

    def __init__(self, line: socket.socket, modules: Sequence[str]) -> None:
        self._line, self._modules = line, modules
        self._owner, self._lock = os.getpid(), threading.Lock()

    def make(self, args: Any, given: dict[str, Any]) -> int:
        """Have the program forked, if it may be; return its process id, or 0."""
        order = _order(args, given, self._modules) if os.getpid() == self._owner else None
        return 0 if order is None else self._ask(order, children.streams(given))

    def _ask(self, order: dict[str, Any], streams: tuple[int, int, int]) -> int:
        """Order a program; return its process id, 0 if the nursery is no more."""
        fds = [number if descriptor == -1 else descriptor for number, descriptor in enumerate(streams)]
        with self._lock:
            try:
                socket.send_fds(self._line, [json.dumps(order).encode()], fds)
                return int(self._line.recv(64) or b"0")
            except OSError:
                return 0


def _order(args: Any, given: dict[str, Any], modules: Sequence[str]) -> dict[str, Any] | None:
    """Return what the nursery is to do; None where it is better left to `subprocess`."""
    plain = all(given[name] == value for name, value in _PLAIN.items()) and not given["pass_fds"]
    if not plain or isinstance(args, str | bytes):
        return None
    words = [os.fsdecode(word) for word in args]
    words = words[1:] if words[:1] == [sys.executable] else words if "/" in words[0] else []  # not one of the PATH
    environment = os.environ if given["env"] is None else given["env"]
    environment = {os.fsdecode(name): os.fsdecode(value) for name, value in environment.items()}
    cwd = Path(os.fsdecode(given["cwd"] or ".")).absolute()
    module = words[1] if words[:1] == ["-m"] and words[1] in modules else ""
    known = module or (words and _is_ours(cwd / words[0]))
    if not known or not cwd.is_dir() or _interpreter(environment) != _interpreter(dict(os.environ)):
        return None
    order = {"environment": environment, "cwd": str(cwd), "session": bool(given["start_new_session"])}
    return {**order, "words": words[2:] if module else words, "module": module}


def _is_ours(script: Path) -> bool:
    """Return whether the kernel would start this interpreter, with no option, for a script."""
    try:
        with script.open("rb") as file:
            return file.readline(4096).rstrip() == b"#!" + os.fsencode(sys.executable) and os.access(script, os.X_OK)
    except OSError:
        return False


def _interpreter(environment: dict[str, str]) -> dict[str, str]:
    """Return what an interpreter reads of its environment when it starts, but for where modules are."""
    return {k: v for k, v in environment.items() if k.startswith(("PYTHON", "LC_", "LANG")) and k != "PYTHONPATH"}


def _serve(line: socket.socket) -> Program | None:
    """Fork for each order, until there are no more; returns in the process of a program only."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # this process ends with the one that it serves
    be_called([])
    while True:
        data, fds, _, _ = socket.recv_fds(line, _MAX_ORDER, 3)
        if not data:
            os._exit(0)
        told, tell = os.pipe()
        adopted, adopts = os.pipe()
        middle = os.fork()
        if middle == 0:
            try:
                child = os.fork()
            except OSError:  # there is no room for more processes
                os._exit(1)
            if child == 0:
                line.detach()
                os.close(adopts)
                os.read(adopted, 1)
                return _child(json.loads(data), fds)
            os.write(tell, b"%d" % child)
            os._exit(0)
        os.waitpid(middle, 0)  # from now on the program has its new parent
        for descriptor in (*fds, tell, adopted, adopts):
            os.close(descriptor)
        line.send(os.read(told, 64) or b"0")
        os.close(told)


def _child(order: dict[str, Any], fds: list[int]) -> Program:
    """Take a child's place, and become its program."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if order["session"]:
        os.setsid()
    for number, descriptor in enumerate(fds):
        os.dup2(descriptor, number)
    os.closerange(len(fds), os.sysconf("SC_OPEN_MAX"))
    given = [part for part in os.environ.get("PYTHONPATH", "").split(os.pathsep) if part]
    base = {path: False for path in sys.path[1:] if path not in given}
    os.chdir(order["cwd"])
    out: Any = sys.stdout
    out.reconfigure(line_buffering=os.isatty(1) and not out.write_through)
    words, module = order["words"], order["module"]
    command = [sys.executable, *(["-m", module] if module else []), *words]
    be_called(command)
    if not module:
        return becoming.become(words, order["environment"], base)
    script = str(importlib.import_module(f"{module}.__main__").__file__)
    program = becoming.become([script, *words], order["environment"], base, first=order["cwd"])
    sys.orig_argv[:] = command
    return open_here() or program
