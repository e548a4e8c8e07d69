"""Claims a `ROS_DOMAIN_ID` that no other caller on this machine has.

A claim is a socket of the operating system's: it ends with its process, however that ends, and reaches as far as a
domain does on one machine, its network namespace. Programs that choose a domain without asking are not kept out.
"""

from __future__ import annotations

import os
import socket
from types import TracebackType

DOMAINS = range(1, 102)  # 0 is everybody's; above 101, ports fall into the range that Linux hands out to others


class Domain:
    """A domain that is claimed until it is closed or this process ends.

    Attributes:
        number: its `ROS_DOMAIN_ID`.
    """

    def __init__(self, first: int | None = None) -> None:
        """Claim the first free domain, or share one when all are taken.

        Args:
            first: where to begin to look, any number; drawn from the process's own when not given.
        """
        start = os.getpid() if first is None else first
        claim = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        for step in range(len(DOMAINS)):
            self.number = DOMAINS[(start + step) % len(DOMAINS)]
            try:
                claim.bind(f"\0ros-domain-{self.number}")
                break
            except OSError:
                continue  # in use by another process
        else:
            self.number = DOMAINS[start % len(DOMAINS)]
        self._descriptor = claim.detach()  # open for as long as the process, whatever becomes of this object

    def close(self) -> None:
        """Leave the domain to others."""
        os.close(self._descriptor)

    def __enter__(self) -> Domain:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
