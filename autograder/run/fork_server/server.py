"""A fork server's process: it forks a program for each request.

It is trusted, lives outside every sandbox, and runs no line of a student's. For each request a child, the supervisor,
enters the sandbox that bubblewrap has made, forks the program's process there, and writes its exit status to the
process that bubblewrap waits for. The program's process gives up all rights (`confinement.py`) before it reads anything
of a student's, and then becomes the program.
"""

from __future__ import annotations

import atexit
import gc
import json
import os
import select
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

from autograder.run.fork_server import confinement
from autograder.run.fork_server.children import fork_children
from autograder.run.fork_server.emulation import Program, emulate_start, forget
from autograder.run.fork_server.profiles import PROFILES
from autograder.run.fork_server.request import MAX_BYTES, MAX_FDS, ForkRequest


def main() -> Program:
    """Serve until the requests end. Return only in the process of a program, with its request."""
    atexit.register(_release)  # the first that is registered is called last
    del sys.path[0]  # the working folder, which -m adds
    requests, profile = socket.socket(fileno=int(sys.argv[1])), PROFILES[sys.argv[2]]
    given = {str(Path(part).absolute()) for part in os.environ.get("PYTHONPATH", "").split(os.pathsep)}
    before = [path for path in sys.path if path not in given]
    gc.disable()  # imported objects are never garbage
    profile.load()
    gc.freeze()  # so that no collection touches shared pages, which would copy them
    gc.enable()
    added = [path for path in sys.path if path not in before and path.startswith(sys.prefix)]  # by setuptools
    base = {path: Path(path).exists() for path in (*before, *added)}
    request = serve(requests)
    forget(("autograder",))
    namespace = {"fork_children": partial(fork_children, profile.own)} if profile.forks else {}
    return emulate_start(request.command, {**request.environment, "PWD": request.workdir}, base, **namespace)


def _release() -> None:
    """Close the files of a program and release rclpy's globals, without finalizing objects that all programs share."""
    for module, name in (("rclpy", "__executor"), ("rclpy.utilities", "g_default_context")):
        if module in sys.modules:
            setattr(sys.modules[module], name, None)


def serve(requests: socket.socket) -> ForkRequest:
    """Fork for each request until they end. Return only in the process of a program, with its request.

    A request is received by the child that it is for: a program finds nothing of earlier ones in its memory.
    """
    while True:
        select.select([requests], [], [])
        taken, told = os.pipe()
        if os.fork() == 0:
            data, fds, _, _ = socket.recv_fds(requests, MAX_BYTES, MAX_FDS)
            if not data:
                os._exit(0)
            os.write(told, b"1")
            request = ForkRequest.from_bytes(data)
            with _reporting(requests):
                if not _supervise(requests, request, fds[0]):
                    _confine(requests, request, fds[1:])
                    return request
            os._exit(0)
        os.close(told)
        received = os.read(taken, 1)
        os.close(taken)
        if not received:
            os._exit(0)
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


@contextmanager
def _reporting(requests: socket.socket) -> Iterator[None]:
    """Answer that the request has failed, and end this process."""
    try:
        yield
    except BaseException as error:
        requests.send(json.dumps({"failed": f"{type(error).__name__}: {error}"}).encode())
        os._exit(1)


def _supervise(requests: socket.socket, request: ForkRequest, status_fd: int) -> bool:
    """Supervise one program until its end; return at once, and False, in the program's own process."""
    for group in request.groups:
        (Path(group) / "cgroup.procs").write_text("0")
    output = os.open(f"/proc/{request.placeholder}/fd/2", os.O_WRONLY)
    inner = confinement.join(request.placeholder)
    program = os.fork()
    if program == 0:
        os.setsid()
        os.dup2(output, 1)
        os.dup2(output, 2)
        confinement.join_user(inner)
        return False
    requests.send(json.dumps({"program": program}).encode())
    _, status = os.waitpid(program, 0)
    code = os.waitstatus_to_exitcode(status)
    with suppress(BrokenPipeError):  # the sandbox was ended from outside
        os.write(status_fd, b"%d\n" % (code if code >= 0 else 128 - code))
    return True


def _confine(requests: socket.socket, request: ForkRequest, fds: list[int]) -> None:
    """Give up whatever is left of the outside, the socket of the requests last of all."""
    os.chdir(request.workdir)
    with socket.socket(fileno=confinement.place(fds, request.fds, requests.detach())) as kept:
        with _reporting(kept):
            confinement.limit(request.limits)
            confinement.drop_privileges()
        kept.send(b'{"entered": true}')
