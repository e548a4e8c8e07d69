"""Hears who joins a DDS domain, without being in it: announcements come to its sockets, whoever makes them.

As soon as a participant is made, it announces itself to the multicast port of its domain, or, told to stay on this
machine, to the first unicast ports. What was said then is in a socket, however busy the machine is and however soon
the participant leaves. Another participant would be no such witness: measured with the wheels, one meeting in seven
takes until the next announcement, up to 3 s, and a test is over sooner.

Source of ports and address: DDS Interoperability Wire Protocol (RTPS) 2.5, section 9.6.2.3.
"""

from __future__ import annotations

import socket
import struct
from types import TracebackType

from autograder.exceptions import GraderError

# Above all that a program would choose, and the ports are above those that the system gives away.
DOMAINS = range(215, 232)
GROUP = "239.255.0.1"
_MAGIC = b"RTPS"


class Ear:
    """Listens in a domain in which nobody is.

    Attributes:
        domain: its `ROS_DOMAIN_ID`.
    """

    def __init__(self) -> None:
        """Find a free domain.

        Raises:
            GraderError: there is somebody in each of them.
        """
        for domain in DOMAINS:
            base = 7400 + 250 * domain
            first = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            try:
                first.bind(("", base + 10))  # the port of the first participant, which has it for itself
            except OSError:
                first.close()
                continue
            self.domain = domain
            self._sockets = (first, _member(base))
            return
        raise GraderError(f"there are participants in all DDS domains from {DOMAINS[0]} to {DOMAINS[-1]}")

    def heard(self) -> bool:
        """Whether somebody has announced itself in the domain since the last time that this was asked."""
        return sum(_take(each) for each in self._sockets) > 0

    def __enter__(self) -> Ear:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for each in self._sockets:
            each.close()


def _member(port: int) -> socket.socket:
    """Return a socket to which all goes that is said to the group on this machine."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # participants bind the port, too
    made.bind((GROUP, port))
    for index, _ in socket.if_nameindex():
        request = struct.pack("4s4si", socket.inet_aton(GROUP), bytes(4), index)
        try:
            made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, request)
        except OSError:
            continue  # an interface that is down, or knows no multicast
    return made


def _take(each: socket.socket) -> int:
    count = 0
    while True:
        try:
            count += each.recv(len(_MAGIC), socket.MSG_DONTWAIT) == _MAGIC
        except BlockingIOError:
            return count
