"""The grader's interface to a fork server."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping
from typing import Any

from autograder.run.fork_server.request import ForkRequest

# The command that bubblewrap starts in place of a forked program. It reports that the sandbox is ready, and exits with
# the status that it receives.
PLACEHOLDER_COMMAND = ["sh", "-c", 'echo >&0; read -r status || status=137; exit "$status"']
TIMEOUT = 60.0  # s for a server's imports, or for one fork, on a busy machine
_ARGV_BYTES = 2048  # space in the server's command line, which programs overwrite with their own command lines


class ForkError(Exception):
    """A program could not be forked."""


class ForkServer:
    """One fork server, which forks one program after another.

    Args:
        profile: the name of its early imports in `PROFILES`.
        environment: its environment variables, which every program can read in its /proc.
    """

    def __init__(self, profile: str, environment: Mapping[str, str]) -> None:
        self._lock = threading.Lock()
        self._socket, server_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._socket.settimeout(TIMEOUT)
        with server_end:
            self._popen = subprocess.Popen(
                [
                    sys.executable,
                    "-m",
                    "autograder.run.fork_server",
                    str(server_end.fileno()),
                    profile,
                    " " * _ARGV_BYTES,
                ],
                stdin=subprocess.DEVNULL,
                env=dict(environment),
                pass_fds=(server_end.fileno(),),
                cwd="/",
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """The server's process id."""
        return self._popen.pid

    def spawn(self, request: ForkRequest, status: int) -> int:
        """Fork a program into an existing sandbox, and return its process id. Raises ForkError if that fails.

        Args:
            request: the program. It inherits the descriptors `request.fds`, with the same numbers.
            status: the descriptor to which its exit status is written as a line.
        """
        with self._lock:
            try:
                socket.send_fds(self._socket, [request.to_bytes()], [status, *request.fds])
                answer: dict[str, Any] = {}
                while not answer.keys() >= {"program", "entered"}:
                    answer |= json.loads(self._socket.recv(4096) or b'{"failed": "the fork server has ended"}')
                    if "failed" in answer:
                        raise ForkError(answer["failed"])
            except OSError as error:
                raise ForkError(str(error)) from error
        return int(answer["program"])

    def close(self) -> None:
        """End the server. Its programs continue."""
        self._socket.close()
        self._popen.kill()
        self._popen.wait()
