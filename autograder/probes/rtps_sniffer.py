"""Receives the announcements of participants in a DDS domain, without being a participant.

A new participant announces itself at once to the multicast port of its domain or, if it is restricted to this machine,
to the first unicast ports. The announcement remains in the sniffer's socket, even on a busy machine and after the
participant has left. A second participant is too slow for this: one discovery in seven takes up to 3 s.

Source of ports and address: DDS Interoperability Wire Protocol (RTPS) 2.5, section 9.6.2.3.
"""

from __future__ import annotations

import socket
import struct

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import DoubtfulError

# Programs rarely choose these domains, whose ports are above those that the system assigns.
DOMAINS = range(215, 232)
GROUP = "239.255.0.1"
_MAGIC = b"RTPS"


class RtpsSniffer:
    """Receives the announcements in a domain that had no participant; `domain` is its `ROS_DOMAIN_ID`."""

    def __init__(self) -> None:
        """Find a free domain; raise a DoubtfulError if each of `DOMAINS` has participants."""
        for domain in DOMAINS:
            base = 7400 + 250 * domain
            first = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            try:
                first.bind(("", base + 10))  # the port of the first participant, which does not share it
            except OSError:
                first.close()
                continue
            self.domain = domain
            self._sockets = (first, _join_group(base))
            return
        sentence = f"All DDS domains from {DOMAINS[0]} to {DOMAINS[-1]} are in use: end the programs that you started."
        raise DoubtfulError(Diagnosis(Kind.STUCK, sentence))

    def take_announcements(self) -> bool:
        """Return whether a participant has announced itself in the domain since the last call."""
        return sum(_count_announcements(sock) for sock in self._sockets) > 0

    def __enter__(self) -> RtpsSniffer:
        return self

    def __exit__(self, *_: object) -> None:
        for sock in self._sockets:
            sock.close()


def _join_group(port: int) -> socket.socket:
    """Return a socket that receives messages to the multicast group on this machine."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)  # participants also bind this port
    sock.bind((GROUP, port))
    for index, _ in socket.if_nameindex():
        request = struct.pack("4s4si", socket.inet_aton(GROUP), bytes(4), index)
        try:
            sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, request)
        except OSError:
            continue  # an interface that is down, or has no multicast
    return sock


def _count_announcements(sock: socket.socket) -> int:
    count = 0
    while True:
        try:
            count += sock.recv(len(_MAGIC), socket.MSG_DONTWAIT) == _MAGIC
        except BlockingIOError:
            return count
