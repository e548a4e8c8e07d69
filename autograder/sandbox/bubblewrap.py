"""Sandboxes as bubblewrap command lines: pure functions from a description to arguments."""

from __future__ import annotations

import sys
from pathlib import Path

from autograder.sandbox.limits import Limits
from autograder.sandbox.spec import Sandbox

# Of /etc, only what the dynamic linker, compilers and fonts read: no accounts, no keys, no host's own settings.
_ETC = ("alternatives", "fonts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "localtime", "magic")
_SYSTEM = ("bin", "lib", "lib32", "lib64", "sbin")


def rlimits(limits: Limits) -> list[str]:
    """Return the `prlimit` prefix that sets the kernel's own limits on each process."""
    return [
        "prlimit",
        f"--cpu={limits.cpu_seconds}:{limits.cpu_seconds + 5}",
        f"--as={limits.address_space}",
        f"--nproc={limits.threads * 4}",
        f"--fsize={limits.file_size}",
        f"--nofile={limits.open_files}",
        "--core=0",
        "--",
    ]


def cell(command: list[str], *, scratch: Path, size: int) -> list[str]:
    """Return the command line of a cell: own user, network and ipc namespace, `scratch` a sized file system.

    The cell has no pid namespace of its own: a bubblewrap inside it could not mount /proc otherwise.
    """
    return [
        "bwrap",
        "--die-with-parent",
        "--unshare-user",
        "--unshare-net",
        "--unshare-ipc",
        "--dev-bind",
        "/",
        "/",
        "--size",
        str(size),
        "--tmpfs",
        str(scratch),
        "--",
        *command,
    ]


def sandbox(command: list[str], spec: Sandbox) -> list[str]:
    """Return the command line that runs `command` in the sandbox that `spec` describes."""
    arguments = [
        *("bwrap", "--die-with-parent", "--new-session", "--clearenv", "--cap-drop", "ALL"),
        *("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"),
        *(() if spec.network else ("--unshare-net",)),
        *("--hostname", "robot"),
        *_system(),
        *("--dev", "/dev", "--proc", "/proc"),
        *("--size", str(spec.limits.scratch), "--tmpfs", "/tmp"),
    ]
    for mount in (*python_mounts(), *spec.mounts):
        path = str(getattr(mount, "path", mount))
        arguments += ["--bind" if getattr(mount, "writable", False) else "--ro-bind", path, path]
    for folder in spec.hidden:
        arguments += ["--tmpfs", str(folder), "--remount-ro", str(folder)]
    for name, value in spec.environment.items():
        arguments += ["--setenv", name, value]
    arguments += ["--chdir", str(spec.workdir), "--", *command]
    return [*rlimits(spec.limits), *arguments]


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
