"""A filter of the system calls of students' programs, see seccomp(2) and bpf(4).

Namespaces and limits are effective without it. It blocks resources that the limits do not count (memory in unmapped
files), that the namespaces do not separate (keys, sockets to a virtual machine's host), and parts of the kernel that no
node needs and that had vulnerabilities. A blocked call fails like one that the kernel does not know (ENOSYS), so that
libraries fall back to others. The filter is for x86-64, like ROS's wheels.
"""

from __future__ import annotations

import errno
import socket
import struct

FORBIDDEN = {
    # memory and queues that belong to no process
    **{"memfd_create": 319, "memfd_secret": 447, "shmget": 29, "semget": 64, "msgget": 68, "mq_open": 240},
    # the kernel's keys
    **{"add_key": 248, "request_key": 249, "keyctl": 250},
    # other processes
    **{"ptrace": 101, "process_vm_readv": 310, "process_vm_writev": 311, "kcmp": 312, "pidfd_getfd": 438},
    # namespaces and mounts; a filter cannot see the flags of clone3, and the C library works without it
    **{"clone3": 435, "unshare": 272, "setns": 308, "mount": 165, "umount2": 166, "pivot_root": 155, "chroot": 161},
    **{"open_tree": 428, "move_mount": 429, "fsopen": 430, "fspick": 433},
    # parts of the kernel that no node needs
    **{"bpf": 321, "perf_event_open": 298, "userfaultfd": 323, "io_uring_setup": 425, "fanotify_init": 300},
    **{"modify_ldt": 154},
}
CLONE, SOCKET = 56, 41
NEW_NAMESPACES = 0x7E020000  # the flags CLONE_NEW... of clone(2)
FAMILIES = (socket.AF_UNIX, socket.AF_INET, socket.AF_INET6, socket.AF_NETLINK)

_X86_64 = 0xC000003E  # AUDIT_ARCH_X86_64; a program of 32 bits has other numbers for its calls
_X32 = 0x40000000  # the lowest number of the calls of x32
_NUMBER, _ARCHITECTURE, _FIRST_ARGUMENT = 0, 4, 16  # in struct seccomp_data
_LOAD, _EQUAL, _AT_LEAST, _ANY_OF, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06  # BPF_LD | BPF_W | BPF_ABS and so on
_ALLOW, _ERROR = 0x7FFF0000, 0x00050000


def program() -> bytes:
    """Return the filter as the kernel's `struct sock_filter`, one after another."""
    forbid, allow, go_on = -2, -1, None  # where a jump leads: the last two instructions, or the next one
    steps: list[tuple[int, int, int | None, int | None]] = [
        (_LOAD, _ARCHITECTURE, go_on, go_on),
        (_EQUAL, _X86_64, go_on, forbid),
        (_LOAD, _NUMBER, go_on, go_on),
        (_AT_LEAST, _X32, forbid, go_on),
        *((_EQUAL, number, forbid, go_on) for number in FORBIDDEN.values()),
        (_EQUAL, SOCKET, 3, go_on),
        (_EQUAL, CLONE, go_on, allow),
        (_LOAD, _FIRST_ARGUMENT, go_on, go_on),
        (_ANY_OF, NEW_NAMESPACES, forbid, allow),
        (_LOAD, _FIRST_ARGUMENT, go_on, go_on),
        *((_EQUAL, family, allow, go_on) for family in FAMILIES),
        (_RETURN, _ERROR | errno.ENOSYS, go_on, go_on),
        (_RETURN, _ALLOW, go_on, go_on),
    ]

    def distance(here: int, to: int | None) -> int:
        return 0 if to is None else to if to >= 0 else len(steps) + to - here - 1

    return b"".join(
        struct.pack("=HBBI", code, distance(here, yes), distance(here, no), value)
        for here, (code, value, yes, no) in enumerate(steps)
    )
