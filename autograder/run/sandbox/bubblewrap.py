"""Translates the description of a sandbox into a command line of bubblewrap, without side effects."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from autograder import course_paths
from autograder.ros import RosError, find
from autograder.run.sandbox import warm_caches
from autograder.run.sandbox.limits import (
    INOTIFY_INSTANCES,
    INOTIFY_WATCHES,
    SIGNALS,
    WORKER_OUT,
    WORKER_SCRATCH,
    WORKER_TMP,
    Limits,
)
from autograder.run.sandbox.spec import Mount, Sandbox, View

# Of /etc, only the files for the dynamic linker, compilers and fonts: no accounts, keys or settings of this machine.
_ETC = ("alternatives", "fonts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "localtime", "magic")
_SYSTEM = ("bin", "lib", "lib32", "lib64", "sbin")
# The kernel counts inotify instances and watches for each user of the machine. A user namespace has limits of its own,
# which its sandboxes share. Setting them needs a capability, which `setpriv` then drops.
_BOUND_KERNEL_OBJECTS = f"""
echo {INOTIFY_INSTANCES} > /proc/sys/user/max_inotify_instances || exit 1
echo {INOTIFY_WATCHES} > /proc/sys/user/max_inotify_watches || exit 1
exec setpriv --inh-caps=-all --ambient-caps=-all --bounding-set=-all "$@"
"""
_RUN_IN_SHELL = '"$@"; exit $?'  # the shell stays in memory, because it has another command to run
_FONTS = "/tmp/matplotlib"
OUT = "out"  # the folder in a worker's scratch folder for its output


def resource_limits(limits: Limits) -> dict[str, tuple[int, int]]:
    """Return the soft and hard limits that the kernel enforces on each process, by their names in `resource`."""
    return {
        "RLIMIT_CPU": (limits.cpu_seconds, limits.cpu_seconds + 5),
        "RLIMIT_AS": (limits.address_space, limits.address_space),
        "RLIMIT_NPROC": (limits.tasks, limits.tasks),
        "RLIMIT_FSIZE": (limits.file_size, limits.file_size),
        "RLIMIT_NOFILE": (limits.open_files, limits.open_files),
        "RLIMIT_SIGPENDING": (SIGNALS, SIGNALS),
        "RLIMIT_CORE": (0, 0),
    }


def rlimits(limits: Limits) -> list[str]:
    """Return the `prlimit` command, up to `--`, that runs another command with `resource_limits`."""
    by_option = {name.removeprefix("RLIMIT_").lower(): bounds for name, bounds in resource_limits(limits).items()}
    return ["prlimit", *(f"--{name}={soft}:{hard}" for name, (soft, hard) in by_option.items()), "--"]


def worker_sandbox(
    command: list[str], view: View, *, scratch: Path, user: int | None = None, groups: tuple[Path, ...] = ()
) -> list[str]:
    """Return the command line of a worker sandbox, which has its own namespaces and sees only `view` of the machine.

    It is read-only except `scratch`, /tmp and the writable folders of `view`. Sandboxes can be nested in it: a nested
    bubblewrap can mount /proc unless the outer one runs as root, because then the outer one hides parts of /proc.

    Args:
        command: the command to run.
        view: the files that it sees in addition to the system and the grader.
        scratch: where a file system in memory, of `limits.WORKER_SCRATCH` bytes, is mounted. Its folder `OUT` is
            another file system, so that the worker can write its result even if a program fills `scratch`.
        user: the user to become, for root; None leaves the user as it is.
        groups: folders of control groups in which the worker sandbox creates groups for its sandboxes.
    """
    unshare = ("--unshare-user", "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts")
    # The command is process 1. Otherwise, process 1 is bubblewrap's own, whose processor time would not be counted.
    namespaces = (
        *unshare,
        "--as-pid-1",
        "--cap-add",
        "CAP_SYS_RESOURCE",
        "--proc",
        "/proc",
        "--setenv",
        "MPLCONFIGDIR",
        _FONTS,
    )
    inner_command = ["sh", "-c", _BOUND_KERNEL_OBJECTS, "sh", *command]
    mounts = _worker_mounts(view, scratch, groups)
    if user is None:
        return ["bwrap", "--die-with-parent", *namespaces, *mounts, "--", *inner_command]
    # Root makes the mounts, because it can access their sources. When a parent dies, the kernel sends the signal to its
    # child with the parent's rights. The outer bubblewrap gives up its rights over other users, but the shell, which
    # stays the parent, keeps them.
    inner = ("bwrap", "--die-with-parent", "--dev-bind", "/", "/", *namespaces)
    outer = ("bwrap", "--die-with-parent", "--bind", "/proc", "/proc", *mounts)
    return [*outer, "--", "sh", "-c", _RUN_IN_SHELL, "sh", *setpriv_command(user), *inner, "--", *inner_command]


def setpriv_command(user: int) -> list[str]:
    """Return the `setpriv` command with which root runs another command as an ordinary user."""
    return ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups", "--no-new-privs", "--pdeathsig=KILL"]


def _worker_mounts(view: View, scratch: Path, groups: tuple[Path, ...]) -> list[str]:
    code_paths = [*python_mounts(), *(path for path in _grader_paths() if path.exists())]
    private_folders = [
        folder for folder in _private_folders() if folder.is_dir() and any(map(folder.is_relative_to, code_paths))
    ]
    covered_folders = [folder for folder in private_folders if not any(map(folder.is_relative_to, view.shown))]
    arguments = [*_open_folders(("/etc",)), *_system(), "--dev", "/dev"]
    size_by_place = {"/tmp": WORKER_TMP, "/dev/shm": WORKER_TMP, scratch: WORKER_SCRATCH, scratch / OUT: WORKER_OUT}
    for place, size in size_by_place.items():
        arguments += ["--perms", "0777", "--size", str(size), "--tmpfs", str(place)]
    for path in code_paths:
        arguments += [*_open_folders(path.parents), "--ro-bind", str(path), str(path)]
    for folder in covered_folders:
        arguments += ["--tmpfs", str(folder)]
    for flag, paths in (("--ro-bind", (*view.shown, *view.submitted)), ("--bind", (*view.writable, *groups))):
        for path in paths:
            arguments += [*_open_folders(path.parents), flag, str(view.copies.get(path, path)), str(path)]
    if (font_list := warm_caches.fonts()) is not None:
        arguments += ["--perms", "0777", "--dir", _FONTS, "--ro-bind", str(font_list), f"{_FONTS}/{font_list.name}"]
    for folder in (*covered_folders, Path("/dev"), Path("/")):
        arguments += ["--remount-ro", str(folder)]
    return arguments


def _open_folders(folders: Iterable[Path | str]) -> list[str]:
    """Return the arguments that create the folders above a mount. By default, only root could enter them."""
    paths = sorted(map(str, folders), key=len)
    return [word for folder in paths if folder != "/" for word in ("--perms", "0755", "--dir", folder)]


def _grader_paths() -> tuple[Path, ...]:
    """Return what every worker sandbox sees of the grader: its code, the course's description, and a sourced ROS."""
    course = (course_paths.course().root / course_paths.COURSE_FILE, course_paths.WORLDS)
    code = (course_paths.ROOT / "autograder", course_paths.ROOT / "sim", course_paths.SHARED_WORLDS)
    try:
        ros = find()
    except RosError:  # some sandboxes do not need ROS
        return (*code, *course)
    return (*code, *course, *(ros.prefixes if ros.kind == "sourced" else ()))


def sandbox(command: list[str], spec: Sandbox, filter_fd: int | None, status_fd: int | None = None) -> list[str]:
    """Return the command line that runs `command` in the sandbox that `spec` describes.

    Args:
        command: the command to run.
        spec: the sandbox.
        filter_fd: a descriptor from which bubblewrap reads the filter of system calls; None for no filter.
        status_fd: a descriptor to which bubblewrap writes the exit status of the command, which does not inherit it.
    """
    arguments = [
        *("bwrap", "--die-with-parent", "--new-session", "--clearenv", "--cap-drop", "ALL"),
        *(() if filter_fd is None else ("--seccomp", str(filter_fd))),
        *(() if status_fd is None else ("--json-status-fd", str(status_fd))),
        *("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"),
        *(() if spec.network else ("--unshare-net",)),
        *("--hostname", "robot"),
        *_system(),
        # Read-only, because every user can write to some of the kernel settings that belong to root.
        *("--dev", "/dev", "--proc", "/proc", "--remount-ro", "/proc"),
        *("--size", str(spec.limits.scratch), "--tmpfs", "/dev/shm"),
        *("--size", str(spec.limits.scratch), "--tmpfs", "/tmp"),
    ]
    mounts = (*(Mount(folder) for folder in python_mounts()), *spec.mounts)
    for mount in mounts:
        source = mount.source or mount.path
        arguments += ["--bind" if mount.writable else "--ro-bind", str(source), str(mount.path)]
    for folder in _private_folders():
        if folder.is_dir() and any(folder.is_relative_to(mount.path) for mount in mounts):
            arguments += ["--tmpfs", str(folder), "--remount-ro", str(folder)]
    # The root and /dev are also file systems in memory, without a size limit.
    arguments += ["--remount-ro", "/dev", "--remount-ro", "/"]
    for name, value in spec.environment.items():
        arguments += ["--setenv", name, value]
    # The limits are set inside the sandbox: outside, the kernel would count all processes of the machine's user.
    return [*arguments, "--chdir", str(spec.workdir), "--", *rlimits(spec.limits), *command]


def python_mounts() -> tuple[Path, ...]:
    """Return the folders of the grader's Python outside the system folders."""
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


def _private_folders() -> tuple[Path, ...]:
    """Return the folders that are hidden in every mount, because they contain answers or checks.

    An installed course is in the Python environment that every sandbox sees.
    """
    return *course_paths.check_folders(), course_paths.SOLUTIONS, course_paths.CHAPTERS
