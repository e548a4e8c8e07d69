"""Enters a sandbox that bubblewrap has created, and drops the privileges that bubblewrap would have dropped.

A forked process has to do what bubblewrap does for a command: join the sandbox's namespaces, drop all capabilities for
good, and set descriptors and limits. See setns(2), ioctl_nsfs(2), capabilities(7), prctl(2), seccomp(2).
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import resource
import struct
from pathlib import Path

from autograder.run.fork_server import seccomp

_NAMESPACES = ("ipc", "uts", "net", "cgroup", "pid", "mnt")
_NS_GET_USERNS = 0xB701
_PR_SET_DUMPABLE, _PR_SET_SECCOMP, _PR_CAPBSET_DROP, _PR_SET_NO_NEW_PRIVS, _PR_CAP_AMBIENT = 4, 22, 24, 38, 47
_PR_CAP_AMBIENT_CLEAR_ALL, _SECCOMP_MODE_FILTER = 4, 2
_CAPABILITY_VERSION_3 = 0x20080522
_MIN_SPARE_FD = 500  # above the numbers that descriptors will get

_libc = ctypes.CDLL(None, use_errno=True)


def join(placeholder: int) -> int:
    """Join the namespaces of the process `placeholder`, except its user namespace. Return a descriptor of the latter.

    This process gets all capabilities in the user namespace that owns the others, because its user has created that
    namespace. The next child of this process is also in the pid namespace.
    """
    target, current = Path(f"/proc/{placeholder}/ns"), Path("/proc/self/ns")
    descriptors = [_open(target / name) for name in _NAMESPACES if not (target / name).samefile(current / name)]
    user = _open(target / "user")
    join_user(fcntl.ioctl(_open(target / "mnt"), _NS_GET_USERNS))
    for descriptor in descriptors:
        _setns(descriptor)
    return user


def join_user(descriptor: int) -> None:
    """Join a user namespace, unless it is already the current one."""
    if not os.path.samestat(os.fstat(descriptor), Path("/proc/self/ns/user").stat()):
        _setns(descriptor)


def place_descriptors(fds: list[int], numbers: list[int], spare: int) -> int:
    """Give descriptors their numbers, connect stdin to /dev/null, and close all others except stdout and stderr.

    Returns:
        The new number of `spare`, which also stays open.
    """
    lowest_spare = max([_MIN_SPARE_FD, *(number + 1 for number in numbers)])
    duplicates = [
        fcntl.fcntl(number, fcntl.F_DUPFD_CLOEXEC, lowest_spare) for number in (spare, _open(Path(os.devnull)), *fds)
    ]
    for descriptor, number in zip(duplicates[1:], [0, *numbers], strict=True):
        os.dup2(descriptor, number)
    open_fds = {0, 1, 2, *numbers, duplicates[0]}
    for number in {int(name) for name in os.listdir("/proc/self/fd")} - open_fds:
        os.closerange(number, number + 1)  # the listing's own descriptor is already closed, which is not an error here
    return duplicates[0]


def set_limits(limits: dict[str, tuple[int, int]]) -> None:
    """Set the kernel's limits on this process, by their names in `resource`."""
    for name, (soft, hard) in limits.items():
        resource.setrlimit(getattr(resource, name), (soft, hard))


def drop_privileges() -> None:
    """Give up every capability, and the system calls that are forbidden in a sandbox."""
    for capability in range(int(Path("/proc/sys/kernel/cap_last_cap").read_text()) + 1):
        _check(_libc.prctl(_PR_CAPBSET_DROP, capability, 0, 0, 0))
    _check(_libc.prctl(_PR_CAP_AMBIENT, _PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0))
    header = (ctypes.c_uint32 * 2)(_CAPABILITY_VERSION_3, 0)
    _check(_libc.capset(header, (ctypes.c_uint32 * 6)()))
    _check(_libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0))
    program = seccomp.program()
    steps = ctypes.create_string_buffer(program)
    filter_struct = struct.pack("HP", len(program) // 8, ctypes.addressof(steps))  # struct sock_fprog
    _check(_libc.prctl(_PR_SET_SECCOMP, _SECCOMP_MODE_FILTER, filter_struct, 0, 0))
    # A process that changes its user namespace loses its own /proc files; starting a program restores them.
    _check(_libc.prctl(_PR_SET_DUMPABLE, 1, 0, 0, 0))


def _open(path: Path) -> int:
    return os.open(path, os.O_RDONLY | os.O_CLOEXEC)


def _setns(descriptor: int) -> None:
    _check(_libc.setns(descriptor, 0))


def _check(result: int) -> None:
    if result != 0:
        number = ctypes.get_errno()
        raise OSError(number, os.strerror(number))
