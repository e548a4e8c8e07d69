"""Sandboxes as bubblewrap command lines: pure functions from a description to arguments."""

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
# The kernel counts these for each user of the machine. A user namespace has a limit of its own, which its sandboxes
# share, and the rest stays for others. It needs a right that is given up with `setpriv`.
_BOUND_KERNEL_OBJECTS = f"""
echo {INOTIFY_INSTANCES} > /proc/sys/user/max_inotify_instances || exit 1
echo {INOTIFY_WATCHES} > /proc/sys/user/max_inotify_watches || exit 1
exec setpriv --inh-caps=-all --ambient-caps=-all --bounding-set=-all "$@"
"""
_STAY = '"$@"; exit $?'  # a shell that has something left to do stays in memory
_FONTS = "/tmp/matplotlib"
OUT = "out"  # the folder of a worker's scratch folder that its output goes to


def resources(limits: Limits) -> dict[str, tuple[int, int]]:
    """Return the kernel's own limits on each process, soft and hard, by their names in `resource`."""
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
    """Return the `prlimit` prefix that sets the kernel's own limits on each process."""
    named = {name.removeprefix("RLIMIT_").lower(): bounds for name, bounds in resources(limits).items()}
    return ["prlimit", *(f"--{name}={soft}:{hard}" for name, (soft, hard) in named.items()), "--"]


def worker_sandbox(
    command: list[str], view: View, *, scratch: Path, user: int | None = None, groups: tuple[Path, ...] = ()
) -> list[str]:
    """Return the command line of a worker sandbox: its own namespaces, and of the machine only what `view` shows.

    It is read-only except `scratch`, /tmp and the writable folders of `view`. Sandboxes can be nested in it: bubblewrap
    can mount /proc inside another one unless the outer one runs as root, for which it hides parts of /proc.

    Args:
        command: the command to run.
        view: the files that it sees in addition to the system and the grader.
        scratch: the folder that is a file system in memory, of `limits.WORKER_SCRATCH` bytes. Its folder `OUT` is
            another one, so that no program that fills `scratch` keeps the worker from writing its result.
        user: the user to become, for root; None leaves the user as it is.
        groups: folders of control groups in which the worker sandbox makes those of its sandboxes.
    """
    apart = ("--unshare-user", "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts")
    # As process 1, because bubblewrap's own would never be waited for, and its processor time would not be counted.
    own_proc = (
        *apart,
        "--as-pid-1",
        "--cap-add",
        "CAP_SYS_RESOURCE",
        "--proc",
        "/proc",
        "--setenv",
        "MPLCONFIGDIR",
        _FONTS,
    )
    inside = ["sh", "-c", _BOUND_KERNEL_OBJECTS, "sh", *command]
    mounts = _worker_mounts(view, scratch, groups)
    if user is None:
        return ["bwrap", "--die-with-parent", *own_proc, *mounts, "--", *inside]
    # Root makes the mounts, for it can reach what they show. The signal of a parent's death is sent with the rights of
    # the parent, and the outer bubblewrap gives up those over another user. The shell keeps them, and stays the parent.
    within = ("bwrap", "--die-with-parent", "--dev-bind", "/", "/", *own_proc)
    made = ("bwrap", "--die-with-parent", "--bind", "/proc", "/proc", *mounts)
    return [*made, "--", "sh", "-c", _STAY, "sh", *becoming(user), *within, "--", *inside]


def becoming(user: int) -> list[str]:
    """Return the words before a command that root runs as another user."""
    return ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups", "--no-new-privs", "--pdeathsig=KILL"]


def _worker_mounts(view: View, scratch: Path, groups: tuple[Path, ...]) -> list[str]:
    code = [*python_mounts(), *(path for path in _grader() if path.exists())]
    private = [folder for folder in _private_folders() if folder.is_dir() and any(map(folder.is_relative_to, code))]
    covered = [folder for folder in private if not any(map(folder.is_relative_to, view.shown))]
    arguments = [*_open_folders(("/etc",)), *_system(), "--dev", "/dev"]
    bounded = {"/tmp": WORKER_TMP, "/dev/shm": WORKER_TMP, scratch: WORKER_SCRATCH, scratch / OUT: WORKER_OUT}
    for place, size in bounded.items():
        arguments += ["--perms", "0777", "--size", str(size), "--tmpfs", str(place)]
    for path in code:
        arguments += [*_open_folders(path.parents), "--ro-bind", str(path), str(path)]
    for folder in covered:
        arguments += ["--tmpfs", str(folder)]
    for flag, paths in (("--ro-bind", (*view.shown, *view.submitted)), ("--bind", (*view.writable, *groups))):
        for path in paths:
            arguments += [*_open_folders(path.parents), flag, str(view.copies.get(path, path)), str(path)]
    if (known := warm_caches.fonts()) is not None:
        arguments += ["--perms", "0777", "--dir", _FONTS, "--ro-bind", str(known), f"{_FONTS}/{known.name}"]
    for folder in (*covered, Path("/dev"), Path("/")):
        arguments += ["--remount-ro", str(folder)]
    return arguments


def _open_folders(folders: Iterable[Path | str]) -> list[str]:
    """Return the arguments that make the folders above a mount: without, root makes them for itself alone."""
    made = sorted(map(str, folders), key=len)
    return [word for folder in made if folder != "/" for word in ("--perms", "0755", "--dir", folder)]


def _grader() -> tuple[Path, ...]:
    """Return the parts of the grader in every worker sandbox: its code, the course's description and a sourced ROS."""
    course = (course_paths.course().root / course_paths.COURSE_FILE, course_paths.WORLDS)
    code = (course_paths.ROOT / "autograder", course_paths.ROOT / "sim", course_paths.SHARED_WORLDS)
    try:
        ros = find()
    except RosError:  # only for sandboxes that ask for it
        return (*code, *course)
    return (*code, *course, *(ros.prefixes if ros.kind == "sourced" else ()))


def sandbox(command: list[str], spec: Sandbox, filter_fd: int | None, status_fd: int | None = None) -> list[str]:
    """Return the command line that runs `command` in the sandbox that `spec` describes.

    Args:
        command: the command to run.
        spec: the sandbox.
        filter_fd: a descriptor from which bubblewrap reads the filter of system calls; None for a trial without.
        status_fd: a descriptor to which bubblewrap writes how the command ended; the command does not inherit it.
    """
    arguments = [
        *("bwrap", "--die-with-parent", "--new-session", "--clearenv", "--cap-drop", "ALL"),
        *(() if filter_fd is None else ("--seccomp", str(filter_fd))),
        *(() if status_fd is None else ("--json-status-fd", str(status_fd))),
        *("--unshare-user", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"),
        *(() if spec.network else ("--unshare-net",)),
        *("--hostname", "robot"),
        *_system(),
        # Read-only, because some kernel settings of root are writable for everybody.
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
    # The root and /dev are file systems in memory, too, without a size.
    arguments += ["--remount-ro", "/dev", "--remount-ro", "/"]
    for name, value in spec.environment.items():
        arguments += ["--setenv", name, value]
    # The limits are set inside: outside, the number of processes would count those of the whole machine's user.
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
    """Return the paths that are hidden in every mount. The sources of notebooks also contain answers.

    An installed course is inside the Python that every sandbox sees.
    """
    return *course_paths.check_folders(), course_paths.SOLUTIONS, course_paths.CHAPTERS
