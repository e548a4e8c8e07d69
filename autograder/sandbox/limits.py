"""What one sandboxed process tree may use."""

from __future__ import annotations

from dataclasses import dataclass

MIB = 1024 * 1024
GIB = 1024 * MIB


@dataclass(frozen=True)
class Limits:
    """Bounds on a process tree; going over one ends the tree.

    Attributes:
        wall_seconds: real time from start to end.
        cpu_seconds: processor time of each process.
        memory: bytes resident in the whole tree.
        address_space: bytes of virtual memory of each process.
        threads: threads in the whole tree.
        file_size: bytes of the largest file written.
        open_files: descriptors of each process.
        output: bytes written to stdout and stderr together.
        scratch: bytes of the private /tmp.
    """

    wall_seconds: float = 120.0
    cpu_seconds: int = 120
    memory: int = 1 * GIB
    address_space: int = 8 * GIB
    threads: int = 256
    file_size: int = 64 * MIB
    open_files: int = 1024
    output: int = 1 * MIB
    scratch: int = 64 * MIB

    @property
    def tasks(self) -> int:
        """Where the kernel refuses one more: well above `threads`, so that going over those is seen and said."""
        return self.threads * 4


# Whoever meets a node bounds each wait for it; the wall's time is for one that all have forgotten.
NODE = Limits(wall_seconds=600.0)
# The processor's time is what bounds a build; the wall's is for one that waits, and not for a machine that is busy.
BUILD = Limits(wall_seconds=420.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
KERNEL = Limits(wall_seconds=180.0, cpu_seconds=180, memory=2 * GIB, output=4 * MIB, scratch=256 * MIB)
