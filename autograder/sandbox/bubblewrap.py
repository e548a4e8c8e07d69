"""Sandboxes as bubblewrap command lines: pure functions from a description to arguments."""

from __future__ import annotations

import sys
from pathlib import Path

from autograder import layout
from autograder.sandbox.limits import Limits
from autograder.sandbox.spec import Mount, Sandbox

# Of /etc, only what the dynamic linker, compilers and fonts read: no accounts, no keys, no host's own settings.
_ETC = ("alternatives", "fonts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "localtime", "magic")
_SYSTEM = ("bin", "lib", "lib32", "lib64", "sbin")
# Covered wherever a mount would show them: an installed course lies inside the Python that every sandbox sees. The
# sources of notebooks hold the answers.
_PRIVATE = (*layout.check_folders(), layout.SOLUTIONS, layout.CHAPTERS)


def resources(limits: Limits) -> dict[str, tuple[int, int]]:
    """Return the kernel's own limits on each process, soft and hard, by their names in `resource`."""
    return {
        "RLIMIT_CPU": (limits.cpu_seconds, limits.cpu_seconds + 5),
        "RLIMIT_AS": (limits.address_space, limits.address_space),
        "RLIMIT_NPROC": (limits.tasks, limits.tasks),
        "RLIMIT_FSIZE": (limits.file_size, limits.file_size),
        "RLIMIT_NOFILE": (limits.open_files, limits.open_files),
        "RLIMIT_CORE": (0, 0),
    }


def rlimits(limits: Limits) -> list[str]:
    """Return the `prlimit` prefix that sets the kernel's own limits on each process."""
    named = {name.removeprefix("RLIMIT_").lower(): bounds for name, bounds in resources(limits).items()}
    return ["prlimit", *(f"--{name}={soft}:{hard}" for name, (soft, hard) in named.items()), "--"]


def cell(command: list[str], *, scratch: Path, size: int) -> list[str]:
    """Return the command line of a cell: own user, network and ipc namespace, `scratch` a file system of `size` bytes.

    The cell has no pid namespace of its own: a bubblewrap inside it could not mount /proc otherwise.
    """
    return [
        *("bwrap", "--die-with-parent", "--unshare-user", "--unshare-net", "--unshare-ipc"),
        *("--dev-bind", "/", "/", "--size", str(size), "--tmpfs", str(scratch), "--", *command),
    ]


def sandbox(command: list[str], spec: Sandbox, filter_fd: int) -> list[str]:
    """Return the command line that runs `command` in the sandbox that `spec` describes.

    `filter_fd` is a descriptor from which bubblewrap reads the filter of system calls.
    """
    arguments = [
        *("bwrap", "--die-with-parent", "--new-session", "--clearenv", "--cap-drop", "ALL"),
        *("--seccomp", str(filter_fd)),
        *("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"),
        *(() if spec.network else ("--unshare-net",)),
        *("--hostname", "robot"),
        *_system(),
        *("--dev", "/dev", "--proc", "/proc"),
        *("--size", str(spec.limits.scratch), "--tmpfs", "/dev/shm"),
        *("--size", str(spec.limits.scratch), "--tmpfs", "/tmp"),
    ]
    mounts = (*(Mount(folder) for folder in python_mounts()), *spec.mounts)
    for mount in mounts:
        arguments += ["--bind" if mount.writable else "--ro-bind", str(mount.path), str(mount.path)]
    for folder in _PRIVATE:
        if folder.is_dir() and any(folder.is_relative_to(mount.path) for mount in mounts):
            arguments += ["--tmpfs", str(folder), "--remount-ro", str(folder)]
    # The root and /dev are file systems in memory, too, without a size.
    arguments += ["--remount-ro", "/dev", "--remount-ro", "/"]
    for name, value in spec.environment.items():
        arguments += ["--setenv", name, value]
    # The limits are set inside: outside, the number of processes would count those of the whole machine's user.
    return [*arguments, "--chdir", str(spec.workdir), "--", *rlimits(spec.limits), *command]


def python_mounts() -> tuple[Path, ...]:
    """Return the folders of the Python that runs the grader, where they lie outside the system's own."""
    folders = {Path(sys.prefix), Path(sys.base_prefix)}
    return tuple(sorted(folder for folder in folders if not folder.is_relative_to("/usr")))


def _system() -> list[str]:
    arguments = ["--ro-bind", "/usr", "/usr"]
    for name in _SYSTEM:
        path = Path("/") / name
        if path.is_symlink():
            arguments += ["--symlink", str(path.readlink()), str(path)]
        elif path.is_dir():
            arguments += ["--ro-bind", str(path), str(path)]
    for name in _ETC:
        path = Path("/etc") / name
        if path.exists():
            arguments += ["--ro-bind", str(path), str(path)]
    return arguments
