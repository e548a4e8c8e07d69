"""The request to a fork server. It describes one program, and is sent through a socket.

The server answers with the program's process id and then "entered", or with the reason why it has "failed".
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

MAX_BYTES = 1024 * 1024  # of a request
MAX_FDS = 16  # file descriptors that are sent with a request


@dataclass(frozen=True)
class ForkRequest:
    """One program to fork."""

    command: list[str]  # its script and arguments
    environment: dict[str, str]  # all its environment variables
    workdir: str  # its working folder
    limits: dict[str, tuple[int, int]]  # the kernel's limits on it, soft and hard, by their names in `resource`
    placeholder: int  # the process in the sandbox that waits for the program's exit status
    groups: list[str]  # the folders of the sandbox's control group
    # The numbers of the descriptors that the program inherits. They are sent with the request, after the one from which
    # the placeholder reads the program's exit status.
    fds: list[int]

    def to_bytes(self) -> bytes:
        """Return the request as JSON."""
        return json.dumps(asdict(self)).encode()

    @classmethod
    def from_bytes(cls, data: bytes) -> ForkRequest:
        """Read a request from its JSON."""
        return cls(**json.loads(data))
