"""The user of each worker sandbox that root starts: a number that no account of the machine has.

Root owns the kernel's settings, and a user namespace does not change that: a process of root can write to them inside a
namespace. Separate users also separate the worker sandboxes in everything that the kernel counts or allows by user.
"""

from __future__ import annotations

import os
import pwd
import socket
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress

from autograder.exceptions import IsolationError

# Debian reserves these, and uses none. A container that maps no more than 65,536 users has them.
_USERS = range(47_000, 48_000)


@contextmanager
def ordinary_user() -> Iterator[int | None]:
    """Claim a user for the duration of the block, or yield None if this process is not root.

    A claim is a socket of the operating system's, which ends with its process.

    Raises:
        IsolationError: all are claimed.
    """
    if os.geteuid() != 0:
        yield None
        return
    with closing(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)) as claim:
        yield next(user for user in _USERS if _claimed(claim, user))


def _claimed(claim: socket.socket, user: int) -> bool:
    if user == _USERS[-1]:
        raise IsolationError("root already runs a thousand worker sandboxes on this machine: wait until some end")
    with suppress(KeyError):
        pwd.getpwuid(user)
        return False
    try:
        claim.bind(f"\0autograder-user-{user}")
    except OSError:
        return False  # used by another worker sandbox
    return True
