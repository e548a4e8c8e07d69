"""The user of each worker sandbox that root starts: a user id that no account of the machine has.

Root owns the kernel's settings, so a process of root can write to them even inside a user namespace. Different users
also separate the worker sandboxes in everything that the kernel counts or permits per user.
"""

from __future__ import annotations

import os
import pwd
import socket
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress

from autograder.exceptions import IsolationError

# Debian reserves these user ids, but uses none. They also exist in a container that maps only 65,536 users.
_USERS = range(47_000, 48_000)


@contextmanager
def ordinary_user() -> Iterator[int | None]:
    """Claim a user for the duration of the block, and yield its id, or None if this process is not root.

    A claim is an abstract socket, which the kernel removes when the claiming process ends.

    Raises:
        IsolationError: all users are claimed.
    """
    if os.geteuid() != 0:
        yield None
        return
    with closing(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)) as lock_socket:
        yield next(user for user in _USERS if _claim(lock_socket, user))


def _claim(lock_socket: socket.socket, user: int) -> bool:
    if user == _USERS[-1]:
        raise IsolationError("root already runs a thousand worker sandboxes on this machine: wait until some end")
    with suppress(KeyError):
        pwd.getpwuid(user)
        return False
    try:
        lock_socket.bind(f"\0autograder-user-{user}")
    except OSError:
        return False  # used by another worker sandbox
    return True
