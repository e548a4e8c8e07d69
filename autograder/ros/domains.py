"""Claims a `ROS_DOMAIN_ID` that no other program on this machine has claimed.

A claim is an abstract Unix socket. It ends with its process, even after a crash. Like the traffic of the domain, it is
limited to one network namespace of the machine. Programs that use a domain without a claim are not detected.

A user's notebooks and terminals share one domain. Each of them binds a socket with the user's id in its name, so the
user keeps the domain until the last of them ends.
"""

from __future__ import annotations

import contextlib
import os
import platform
import re
import secrets
import socket
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

from autograder.ros.exceptions import NoFreeDomainError

DOMAINS = range(1, 102)  # 0 is every program's default; above 101, the ports are in Linux's ephemeral range
_UNIX_SOCKETS = Path("/proc/net/unix")  # lists the sockets of this network namespace; `@` marks an abstract name
_LOCK_TIMEOUT = 10.0  # s; how long to wait for another program of the user that is choosing a domain
_SHARE = re.compile(r" @ros-domain-(?P<number>\d+)-(?P<user>\d+)-(?P<token>[0-9a-f]+)$", re.MULTILINE)


class Domain:
    """A claimed domain. `close` or the end of this process releases it.

    Attributes:
        number: its `ROS_DOMAIN_ID`.
    """

    def __init__(self, first: int | None = None, *, user: int | None = None) -> None:
        """Claim the domain that the user's other programs share, or the first free one.

        Args:
            first: any number, which determines the domain that is tried first. By default, it is derived from the
                process id, or from the user id if `user` is given.
            user: a user id. All claims of this user share one domain. By default, the domain is not shared.

        Raises:
            NoFreeDomainError: all domains are in use.
        """
        self._descriptors: tuple[int, ...] = ()
        if user is None:
            self._claim_free(os.getpid() if first is None else first)
            return
        with _lock(user):  # so that two programs started at the same time share a domain
            if not self._join(user):
                self._claim_free(_default_start(user) if first is None else first)
                self._descriptors += (_bind(_share_name(self.number, user)),)

    def keep_across_exec(self) -> None:
        """Keep the domain claimed when this process calls `exec`."""
        for descriptor in self._descriptors:
            os.set_inheritable(descriptor, True)

    def close(self) -> None:
        """Release the domain."""
        for descriptor in self._descriptors:
            os.close(descriptor)
        self._descriptors = ()

    def __enter__(self) -> Domain:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _claim_free(self, start: int) -> None:
        for offset in range(len(DOMAINS)):
            number = DOMAINS[(start + offset) % len(DOMAINS)]
            try:
                claim = _bind(f"ros-domain-{number}")
            except OSError:
                continue  # in use by another process
            if not any(int(share["number"]) == number for share in _shares()):
                self.number, self._descriptors = number, (claim,)
                return
            os.close(claim)  # the program that claimed it has ended, but other programs still share it
        raise NoFreeDomainError(
            f"all {len(DOMAINS)} ROS domains of this machine are in use: stop notebooks and programs that you do not "
            "need, or try again later"
        )

    def _join(self, user: int) -> bool:
        """Join the domain that the user's other programs share; return whether they have one."""
        for share in _shares(user):
            number = int(share["number"])
            claim = _bind(_share_name(number, user))
            # If the other program's share still exists, the domain cannot have been released in between.
            if share["token"] in {other["token"] for other in _shares(user)}:
                self.number, self._descriptors = number, (claim,)
                return True
            os.close(claim)
        return False


def _default_start(user: int) -> int:
    """Return the number at which the search starts, which depends on the user and on the machine's name."""
    return user + zlib.crc32(platform.node().encode())


def _bind(name: str) -> int:
    """Bind a socket to this abstract name, and return its descriptor, which stays open until the process ends."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as claim:
        claim.bind(f"\0{name}")
        return claim.detach()


def _share_name(number: int, user: int) -> str:
    return f"ros-domain-{number}-{user}-{secrets.token_hex(8)}"


def _shares(user: int | None = None) -> list[re.Match[str]]:
    """Return a match for each socket that shares a domain of this user, or of any user."""
    try:
        names = _UNIX_SOCKETS.read_text(errors="replace")
    except OSError:  # some sandboxes do not have this file; then no domain is shared
        return []
    return [share for share in _SHARE.finditer(names) if user is None or int(share["user"]) == user]


@contextlib.contextmanager
def _lock(user: int) -> Iterator[None]:
    """Hold the user's lock while the block runs. If the lock is not free in time, run the block without it."""
    name, deadline = f"\0ros-domains-of-{user}", time.monotonic() + _LOCK_TIMEOUT
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as lock:
        while time.monotonic() < deadline:
            try:
                lock.bind(name)
                lock.listen()
                break
            except OSError:
                with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as client:
                    client.settimeout(_LOCK_TIMEOUT)
                    client.connect(name)
                    client.recv(1)  # returns when the other process closes its socket
        yield
