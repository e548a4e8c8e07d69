"""Claims a `ROS_DOMAIN_ID` that no other caller on this machine has.

A claim is a socket of the operating system's: it ends with its process, however that ends, and reaches as far as a
domain does on one machine, its network namespace. Programs that choose a domain without asking are not kept out.

A user's notebooks and terminals share one domain. Each of them adds a socket with the user's id in its name, so the
domain stays the user's until the last of them ends.
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

from autograder.ros.exceptions import NoDomainLeftError

DOMAINS = range(1, 102)  # 0 is everybody's; above 101, ports fall into the range that Linux hands out to others
_NAMES = Path("/proc/net/unix")  # all such sockets of this network namespace; `@` begins a name without a file
_TURN_SECONDS = 10.0
_SHARE = re.compile(r" @ros-domain-(?P<number>\d+)-(?P<user>\d+)-(?P<share>[0-9a-f]+)$", re.MULTILINE)


class Domain:
    """A domain that is claimed until it is closed or this process ends.

    Attributes:
        number: its `ROS_DOMAIN_ID`.
    """

    def __init__(self, first: int | None = None, *, user: int | None = None) -> None:
        """Claim the domain that the user has, or the first free one.

        Args:
            first: where to begin to look, any number; drawn from the process's own, or from the user's, when not given.
            user: the id of the user whose claims all get the same domain. By default, the claim shares with no other.

        Raises:
            NoDomainLeftError: all domains are in use.
        """
        self._descriptors: tuple[int, ...] = ()
        if user is None:
            self._take(os.getpid() if first is None else first)
            return
        with _turn(user):  # two programs that the user starts at the same time do not take one domain each
            if not self._join(user):
                self._take(_usual(user) if first is None else first)
                self._descriptors += (_bind(_share_name(self.number, user)),)

    def keep_in_next_program(self) -> None:
        """Keep the domain claimed when this process becomes another program by `exec`."""
        for descriptor in self._descriptors:
            os.set_inheritable(descriptor, True)

    def close(self) -> None:
        """Leave the domain to others."""
        for descriptor in self._descriptors:
            os.close(descriptor)
        self._descriptors = ()

    def __enter__(self) -> Domain:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _take(self, start: int) -> None:
        for step in range(len(DOMAINS)):
            number = DOMAINS[(start + step) % len(DOMAINS)]
            try:
                claim = _bind(f"ros-domain-{number}")
            except OSError:
                continue  # in use by another process
            if not any(int(share["number"]) == number for share in _shares()):
                self.number, self._descriptors = number, (claim,)
                return
            os.close(claim)  # the program that took it has ended, but not all that share it
        raise NoDomainLeftError(
            f"all {len(DOMAINS)} ROS domains of this machine are in use: stop notebooks and programs that you do not "
            "need, or try again later"
        )

    def _join(self, user: int) -> bool:
        """Share the domain that the user has; return whether there is one."""
        for share in _shares(user):
            number = int(share["number"])
            own = _bind(_share_name(number, user))
            # It is still there, so in between nobody else can have taken the domain.
            if share["share"] in {other["share"] for other in _shares(user)}:
                self.number, self._descriptors = number, (own,)
                return True
            os.close(own)
        return False


def _usual(user: int) -> int:
    """Return where to look first: another number for each user of a machine, and for the same user elsewhere."""
    return user + zlib.crc32(platform.node().encode())


def _bind(name: str) -> int:
    """Return the descriptor of a socket with this name. It is open for as long as the process, without an object."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as claim:
        claim.bind(f"\0{name}")
        return claim.detach()


def _share_name(number: int, user: int) -> str:
    return f"ros-domain-{number}-{user}-{secrets.token_hex(8)}"


def _shares(user: int | None = None) -> list[re.Match[str]]:
    """Return the shares in the domains of all users, or of one."""
    try:
        names = _NAMES.read_text(errors="replace")
    except OSError:  # not every sandbox has the file; then each program has a domain for itself
        return []
    return [share for share in _SHARE.finditer(names) if user is None or int(share["user"]) == user]


@contextlib.contextmanager
def _turn(user: int) -> Iterator[None]:
    """Run the block while no other process does for this user; after `_TURN_SECONDS`, run it all the same."""
    name, deadline = f"\0ros-domains-of-{user}", time.monotonic() + _TURN_SECONDS
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as turn:
        while time.monotonic() < deadline:
            try:
                turn.bind(name)
                turn.listen()
                break
            except OSError:
                with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as waiting:
                    waiting.settimeout(_TURN_SECONDS)
                    waiting.connect(name)
                    waiting.recv(1)  # returns when the other process closes its socket
        yield
