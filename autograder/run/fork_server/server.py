"""A fork server's process: it forks a program for each request.

It is trusted, runs outside every sandbox, and executes no student code. For each request, a child, the supervisor,
enters the sandbox that bubblewrap has created, forks the program's process there, and writes its exit status to the
placeholder for which bubblewrap waits. The program's process gives up all rights (`confinement.py`) before it reads any
student's file, and then becomes the program.
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
from autograder.run.fork_server.emulation import Program, emulate_start, unload_packages
from autograder.run.fork_server.profiles import PROFILES
from autograder.run.fork_server.request import MAX_BYTES, MAX_FDS, ForkRequest


def main() -> Program:
    """Serve until the requests end. Return only in the process of a program, with its code and globals."""
    atexit.register(_release)  # registered first, so that it is called last
    del sys.path[0]  # the working folder, which -m adds
    requests, profile = socket.socket(fileno=int(sys.argv[1])), PROFILES[sys.argv[2]]
    python_path = {str(Path(part).absolute()) for part in os.environ.get("PYTHONPATH", "").split(os.pathsep)}
    initial_paths = [path for path in sys.path if path not in python_path]
    gc.disable()  # imported objects are never garbage
    profile.load()
    gc.freeze()  # a garbage collection would write to shared memory pages, and so copy them
    gc.enable()
    # setuptools adds paths.
    added_paths = [path for path in sys.path if path not in initial_paths and path.startswith(sys.prefix)]
    base_paths = {path: Path(path).exists() for path in (*initial_paths, *added_paths)}
    request = serve(requests)
    unload_packages(("autograder",))
    namespace = {"fork_children": partial(fork_children, profile.own_packages)} if profile.forks_children else {}
    return emulate_start(request.command, {**request.environment, "PWD": request.workdir}, base_paths, **namespace)


def _release() -> None:
    """Close the files of a program and release rclpy's globals, without finalizing objects that all programs share."""
    for module, name in (("rclpy", "__executor"), ("rclpy.utilities", "g_default_context")):
        if module in sys.modules:
            setattr(sys.modules[module], name, None)


def serve(requests: socket.socket) -> ForkRequest:
    """Fork for each request until they end. Return only in the process of a program, with its request.

    Each request is received by a new child, so that a program finds no earlier requests in its memory.
    """
    while True:
        select.select([requests], [], [])
        receipt_reader, receipt_writer = os.pipe()
        if os.fork() == 0:
            data, fds, _, _ = socket.recv_fds(requests, MAX_BYTES, MAX_FDS)
            if not data:
                os._exit(0)
            os.write(receipt_writer, b"1")
            request = ForkRequest.from_bytes(data)
            with _report_failure_to(requests):
                if not _supervise(requests, request, fds[0]):
                    _confine(requests, request, fds[1:])
                    return request
            os._exit(0)
        os.close(receipt_writer)
        receipt = os.read(receipt_reader, 1)
        os.close(receipt_reader)
        if not receipt:
            os._exit(0)
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


@contextmanager
def _report_failure_to(requests: socket.socket) -> Iterator[None]:
    """If the block fails, answer that the request has failed, and end this process."""
    try:
        yield
    except BaseException as error:
        requests.send(json.dumps({"failed": f"{type(error).__name__}: {error}"}).encode())
        os._exit(1)


def _supervise(requests: socket.socket, request: ForkRequest, status_fd: int) -> bool:
    """Supervise one program until its end, and return True. In the program's own process, return False at once."""
    for group in request.groups:
        (Path(group) / "cgroup.procs").write_text("0")
    output = os.open(f"/proc/{request.placeholder}/fd/2", os.O_WRONLY)
    user_namespace = confinement.join(request.placeholder)
    program = os.fork()
    if program == 0:
        os.setsid()
        os.dup2(output, 1)
        os.dup2(output, 2)
        confinement.join_user(user_namespace)
        return False
    requests.send(json.dumps({"program": program}).encode())
    _, status = os.waitpid(program, 0)
    code = os.waitstatus_to_exitcode(status)
    with suppress(BrokenPipeError):  # the sandbox was killed
        os.write(status_fd, b"%d\n" % (code if code >= 0 else 128 - code))
    return True


def _confine(requests: socket.socket, request: ForkRequest, fds: list[int]) -> None:
    """Give up all access to the outside, and finally close the socket of the requests."""
    os.chdir(request.workdir)
    with socket.socket(fileno=confinement.place_descriptors(fds, request.fds, requests.detach())) as reply_socket:
        with _report_failure_to(reply_socket):
            confinement.set_limits(request.limits)
            confinement.drop_privileges()
        reply_socket.send(b'{"entered": true}')
