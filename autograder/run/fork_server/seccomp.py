"""A filter for the system calls of students' programs; see seccomp(2) and bpf(4).

It complements namespaces and limits. It blocks resources that the limits do not count (memory in unmapped files),
resources that the namespaces do not separate (keys, sockets to a virtual machine's host), and parts of the kernel that
no node needs and that had vulnerabilities. A blocked call fails like an unknown one (ENOSYS), so that libraries use
other calls instead. The filter is for x86-64, like ROS's wheels.
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

_X86_64 = 0xC000003E  # AUDIT_ARCH_X86_64; 32-bit programs use other call numbers
_X32 = 0x40000000  # the lowest call number of the x32 ABI
_NUMBER, _ARCHITECTURE, _FIRST_ARGUMENT = 0, 4, 16  # in struct seccomp_data
_LOAD, _EQUAL, _AT_LEAST, _ANY_OF, _RETURN = 0x20, 0x15, 0x35, 0x45, 0x06  # BPF_LD | BPF_W | BPF_ABS and so on
_ALLOW, _ERROR = 0x7FFF0000, 0x00050000


def program() -> bytes:
    """Return the filter as an array of the kernel's `struct sock_filter`."""
    forbid, allow, next_step = -2, -1, None  # jump targets: the last two instructions, or the next one
    steps: list[tuple[int, int, int | None, int | None]] = [
        (_LOAD, _ARCHITECTURE, next_step, next_step),
        (_EQUAL, _X86_64, next_step, forbid),
        (_LOAD, _NUMBER, next_step, next_step),
        (_AT_LEAST, _X32, forbid, next_step),
        *((_EQUAL, number, forbid, next_step) for number in FORBIDDEN.values()),
        (_EQUAL, SOCKET, 3, next_step),
        (_EQUAL, CLONE, next_step, allow),
        (_LOAD, _FIRST_ARGUMENT, next_step, next_step),
        (_ANY_OF, NEW_NAMESPACES, forbid, allow),
        (_LOAD, _FIRST_ARGUMENT, next_step, next_step),
        *((_EQUAL, family, allow, next_step) for family in FAMILIES),
        (_RETURN, _ERROR | errno.ENOSYS, next_step, next_step),
        (_RETURN, _ALLOW, next_step, next_step),
    ]

    def distance(index: int, target: int | None) -> int:
        return 0 if target is None else target if target >= 0 else len(steps) + target - index - 1

    return b"".join(
        struct.pack("=HBBI", code, distance(index, if_true), distance(index, if_false), value)
        for index, (code, value, if_true, if_false) in enumerate(steps)
    )
