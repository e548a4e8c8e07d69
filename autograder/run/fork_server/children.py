"""A child fork server: forks the children of a forked program as well, instead of starting new interpreters.

The children of `ros2 launch` would import the same modules as the launch, and those of colcon would import setuptools.
The program cannot fork them itself, because it has threads and its own data in memory. So it first forks the child fork
server, whose memory stays unchanged. The server forks for each command that is passed to `subprocess`. Only scripts of
this Python are forked. All other commands are started as usual, and so is every command if this Python's `subprocess`
is of an unknown version.

The parent of a program is the process that requested it: the server's child forks the program and ends, and then the
requesting process adopts the program (`prctl(2)`, PR_SET_CHILD_SUBREAPER). All of this runs inside the sandbox, where
the student's code can interfere.
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

from autograder.run.fork_server.emulation import emulate_start, set_command_line, unload_packages
from autograder.run.fork_server.request import MAX_BYTES

_PR_SET_CHILD_SUBREAPER = 36
_PIPES = ("p2cread", "p2cwrite", "c2pread", "c2pwrite", "errread", "errwrite")
_PARAMETERS = [  # the parameters of CPython's `Popen._execute_child`
    *("self", "args", "executable", "preexec_fn", "close_fds", "pass_fds", "cwd", "env", "startupinfo"),
    *("creationflags", "shell", *_PIPES),
    *("restore_signals", "gid", "gids", "uid", "umask", "start_new_session"),
]
_DEFAULTS: dict[str, Any] = {
    "preexec_fn": None,
    "close_fds": True,
    "shell": False,
    "restore_signals": True,
    "umask": -1,
}
_DEFAULTS |= dict.fromkeys(("executable", "gid", "gids", "uid"))


def fork_children(own_packages: Sequence[str]) -> None:
    """From now on, fork the programs that this one starts. In the forked processes, this function does not return.

    Call it while the program has one thread, and has not read any of the student's data. Only the program itself, not
    its children, uses packages whose names begin with a word in `own_packages`.
    """
    original = getattr(subprocess.Popen, "_execute_child", None)
    if original is None or list(inspect.signature(original).parameters)[: len(_PARAMETERS)] != _PARAMETERS:
        return
    ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    client_end, server_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    sys.stdout.flush()
    if os.fork() == 0:
        client_end.close()
        unload_packages(own_packages)
        logging.root.handlers.clear()  # its children do not inherit its logging
        logging.root.setLevel(logging.WARNING)
        _serve(server_end)
    server_end.close()
    owner, lock = os.getpid(), threading.Lock()

    def execute(popen: Any, args: Any, *values: Any) -> None:
        arguments = dict(zip(_PARAMETERS[2:], values, strict=False))
        request = _request(args, arguments) if os.getpid() == owner else None
        with lock:
            pid = 0 if request is None else _request_fork(client_end, request, arguments)
        if not pid:
            original(popen, args, *values)
            return
        popen.pid, popen._child_created = pid, True
        popen._close_pipe_fds(*[arguments[name] for name in _PIPES])

    subprocess.Popen._execute_child = execute  # type: ignore[attr-defined]


def _request_fork(line: socket.socket, request: dict[str, Any], arguments: dict[str, Any]) -> int:
    """Request a fork. Return the process id of the program, or 0 if the server has ended."""
    streams = (arguments["p2cread"], arguments["c2pwrite"], arguments["errwrite"])
    fds = [number if descriptor == -1 else descriptor for number, descriptor in enumerate(streams)]
    try:
        socket.send_fds(line, [json.dumps(request).encode()], fds)
        return int(line.recv(64) or b"0")
    except OSError:
        return 0


def _request(args: Any, arguments: dict[str, Any]) -> dict[str, Any] | None:
    """Return the request to the server, or None if `subprocess` has to start the program."""
    has_defaults = all(arguments[name] == value for name, value in _DEFAULTS.items()) and not arguments["pass_fds"]
    if not has_defaults or isinstance(args, str | bytes):
        return None
    environment = os.environ if arguments["env"] is None else arguments["env"]
    environment = {os.fsdecode(name): os.fsdecode(value) for name, value in environment.items()}
    cwd = Path(os.fsdecode(arguments["cwd"] or ".")).absolute()
    words = _python_words([os.fsdecode(word) for word in args], cwd)
    if not words or not cwd.is_dir() or _interpreter(environment) != _interpreter(dict(os.environ)):
        return None
    return {
        "words": words,
        "environment": environment,
        "cwd": str(cwd),
        "session": bool(arguments["start_new_session"]),
    }


def _python_words(words: list[str], cwd: Path) -> list[str]:
    """Return the words after `python` in a command line for this interpreter, or nothing if it is for another one."""
    if words[:1] == [sys.executable]:
        options = 1
        while words[options : options + 1] == ["-W"]:
            options += 2
        is_known = words[options : options + 1] == ["-c"] or (cwd / "".join(words[options : options + 1])).is_file()
        return words[1:] if is_known else []
    # A script counts if its first line names this interpreter, without options. A command without a slash would be
    # searched in PATH.
    script = cwd / words[0]
    try:
        with script.open("rb") as file:
            has_our_shebang = file.readline(4096).rstrip() == b"#!" + os.fsencode(sys.executable)
    except OSError:
        return []
    return words if "/" in words[0] and has_our_shebang and os.access(script, os.X_OK) else []


def _interpreter(environment: dict[str, str]) -> dict[str, str]:
    """Return the environment variables that an interpreter reads at its start, except those for module paths."""
    return {k: v for k, v in environment.items() if k.startswith(("PYTHON", "LC_", "LANG")) and k != "PYTHONPATH"}


def _serve(line: socket.socket) -> None:
    """Fork a program for each request, until the requests end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # this process ends with its client
    set_command_line([])
    while True:
        data, fds, _, _ = socket.recv_fds(line, MAX_BYTES, 3)
        if not data:
            os._exit(0)
        pid_reader, pid_writer = os.pipe()
        adoption_reader, adoption_writer = os.pipe()
        intermediate = os.fork()
        if intermediate == 0:
            try:
                child = os.fork()
            except OSError:  # the limit on processes is reached
                os._exit(1)
            if child == 0:
                line.detach()
                os.close(adoption_writer)
                os.read(adoption_reader, 1)
                _run(json.loads(data), fds)
            os.write(pid_writer, b"%d" % child)
            os._exit(0)
        os.waitpid(intermediate, 0)  # from now on the program has its new parent
        for descriptor in (*fds, pid_writer, adoption_reader, adoption_writer):
            os.close(descriptor)
        line.send(os.read(pid_reader, 64) or b"0")
        os.close(pid_reader)


def _run(request: dict[str, Any], fds: list[int]) -> None:
    """Become the program of a request, and run it to its end."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if request["session"]:
        os.setsid()
    for number, descriptor in enumerate(fds):
        os.dup2(descriptor, number)
    os.closerange(len(fds), os.sysconf("SC_OPEN_MAX"))
    python_path = {str(Path(part).absolute()) for part in os.environ.get("PYTHONPATH", "").split(os.pathsep)}
    base = {path: False for path in sys.path[1:] if path not in python_path}
    os.chdir(request["cwd"])
    out: Any = sys.stdout
    out.reconfigure(line_buffering=os.isatty(1) and not out.write_through)
    exec(*emulate_start(request["words"], request["environment"], base))
    sys.exit()
