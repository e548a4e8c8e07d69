"""Also forks, rather than spawns, the children of a forked program: a child fork server.

The children of `ros2 launch` would import the same modules as the launch, and those of colcon would import setuptools.
The program cannot fork them itself, because it has threads and its own data in memory. So it first forks the child fork
server, which stays unchanged, and forks for each command that is passed to `subprocess`. Only scripts of this Python
are forked. All other commands are started as usual, and so is every command if this Python's `subprocess` is of an
unknown version.

The parent of a program is the process that asked for it: the server's child forks it and ends, and then it is adopted
(`prctl(2)`, PR_SET_CHILD_SUBREAPER). All of this runs inside the sandbox, where the student's code can interfere.
"""

from __future__ import annotations

import ctypes
import inspect
import json
import logging
import os
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from autograder.run.fork_server.emulation import emulate_start, forget, set_command_line
from autograder.run.fork_server.request import MAX_BYTES

_PR_SET_CHILD_SUBREAPER = 36
_PIPES = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
_PARAMETERS = [  # of CPython's `Popen._execute_child`
    *("self", "args", "executable", "preexec_fn", "close_fds", "pass_fds", "cwd", "env", "startupinfo"),
    *("creationflags", "shell", *_PIPES),
    *("restore_signals", "gid", "gids", "uid", "umask", "start_new_session"),
]
_PLAIN: dict[str, Any] = {"preexec_fn": None, "close_fds": True, "shell": False, "restore_signals": True, "umask": -1}
_PLAIN |= dict.fromkeys(("executable", "gid", "gids", "uid"))


def fork_children(own: Sequence[str]) -> None:
    """From now on, fork the programs that this one starts. In their processes, this function does not return.

    It is to be called while the program has one thread, and has read nothing of the student's. `own` are first words of
    the names of packages that only the program itself has, not its children.
    """
    before = getattr(subprocess.Popen, "_execute_child", None)
    if before is None or list(inspect.signature(before).parameters)[: len(_PARAMETERS)] != _PARAMETERS:
        return
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    sys.stdout.flush()
    if os.fork() == 0:
        ours.close()
        forget(own)
        logging.root.handlers.clear()  # how the program logs is its own affair, too
        logging.root.setLevel(logging.WARNING)
        _serve(theirs)
    theirs.close()
    owner, lock = os.getpid(), threading.Lock()

    def execute(popen: Any, args: Any, *more: Any) -> None:
        given = dict(zip(_PARAMETERS[2:], more, strict=False))
        request = _request(args, given) if os.getpid() == owner else None
        with lock:
            pid = 0 if request is None else _ask(ours, request, given)
        if not pid:
            before(popen, args, *more)
            return
        popen.pid, popen._child_created = pid, True
        popen._close_pipe_fds(*[given[name] for name in _PIPES])

    subprocess.Popen._execute_child = execute  # type: ignore[attr-defined]


def _ask(line: socket.socket, request: dict[str, Any], given: dict[str, Any]) -> int:
    """Request a fork; return the process id of the program, or 0 if the server has ended."""
    streams = (given["p2cread"], given["c2pwrite"], given["errwrite"])
    fds = [number if descriptor == -1 else descriptor for number, descriptor in enumerate(streams)]
    try:
        socket.send_fds(line, [json.dumps(request).encode()], fds)
        return int(line.recv(64) or b"0")
    except OSError:
        return 0


def _request(args: Any, given: dict[str, Any]) -> dict[str, Any] | None:
    """Return the request to the server, or None if `subprocess` has to start the program."""
    plain = all(given[name] == value for name, value in _PLAIN.items()) and not given["pass_fds"]
    if not plain or isinstance(args, str | bytes):
        return None
    environment = os.environ if given["env"] is None else given["env"]
    environment = {os.fsdecode(name): os.fsdecode(value) for name, value in environment.items()}
    cwd = Path(os.fsdecode(given["cwd"] or ".")).absolute()
    words = _python_words([os.fsdecode(word) for word in args], cwd)
    if not words or not cwd.is_dir() or _interpreter(environment) != _interpreter(dict(os.environ)):
        return None
    return {"words": words, "environment": environment, "cwd": str(cwd), "session": bool(given["start_new_session"])}


def _python_words(words: list[str], cwd: Path) -> list[str]:
    """Return the words after `python` in a command line for this interpreter, or nothing for another one."""
    if words[:1] == [sys.executable]:
        options = 1
        while words[options : options + 1] == ["-W"]:
            options += 2
        known = words[options : options + 1] == ["-c"] or (cwd / "".join(words[options : options + 1])).is_file()
        return words[1:] if known else []
    # A script's first line names it, with no option. A command without a slash is one of the PATH.
    script = cwd / words[0]
    try:
        with script.open("rb") as file:
            ours = file.readline(4096).rstrip() == b"#!" + os.fsencode(sys.executable)
    except OSError:
        return []
    return words if "/" in words[0] and ours and os.access(script, os.X_OK) else []


def _interpreter(environment: dict[str, str]) -> dict[str, str]:
    """Return the environment variables that an interpreter reads at its start, except those for module paths."""
    return {k: v for k, v in environment.items() if k.startswith(("PYTHON", "LC_", "LANG")) and k != "PYTHONPATH"}


def _serve(line: socket.socket) -> None:
    """Fork a program for each request, until the requests end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # this process ends with the one that it serves
    set_command_line([])
    while True:
        data, fds, _, _ = socket.recv_fds(line, MAX_BYTES, 3)
        if not data:
            os._exit(0)
        told, tell = os.pipe()
        adopted, adopts = os.pipe()
        middle = os.fork()
        if middle == 0:
            try:
                child = os.fork()
            except OSError:  # the limit of processes is reached
                os._exit(1)
            if child == 0:
                line.detach()
                os.close(adopts)
                os.read(adopted, 1)
                _run(json.loads(data), fds)
            os.write(tell, b"%d" % child)
            os._exit(0)
        os.waitpid(middle, 0)  # from now on the program has its new parent
        for descriptor in (*fds, tell, adopted, adopts):
            os.close(descriptor)
        line.send(os.read(told, 64) or b"0")
        os.close(told)


def _run(request: dict[str, Any], fds: list[int]) -> None:
    """Take a child's place, and run its program to its end."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if request["session"]:
        os.setsid()
    for number, descriptor in enumerate(fds):
        os.dup2(descriptor, number)
    os.closerange(len(fds), os.sysconf("SC_OPEN_MAX"))
    given = {str(Path(part).absolute()) for part in os.environ.get("PYTHONPATH", "").split(os.pathsep)}
    base = {path: False for path in sys.path[1:] if path not in given}
    os.chdir(request["cwd"])
    out: Any = sys.stdout
    out.reconfigure(line_buffering=os.isatty(1) and not out.write_through)
    exec(*emulate_start(request["words"], request["environment"], base))
    sys.exit()
