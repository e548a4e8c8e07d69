"""Limits that the kernel enforces on a whole sandbox: its number of processes, and its memory of any kind.

`prlimit --nproc` also limits the number of processes, but the kernel does not apply it to root (setrlimit(2),
RLIMIT_NPROC). Watching is not enough, because a fork bomb grows faster than it can be counted. Only control groups
count memory that no process has mapped (files in memory, buffers of sockets, inodes), and the processor time of ended
processes for which no parent has waited. See cgroups(7), versions 1 and 2.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import subprocess
import time
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

from autograder.run.sandbox.limits import Limits

_NUMBERS = itertools.count()
# Part of each group's name. A process id is not unique enough: worker sandboxes may share both ids and a folder.
_PROCESS = os.urandom(6).hex()
_NAME = "autograder"
_LEAF = "worker"
_COUNTER = {"cpuacct": {"cpuacct.usage": 0}}  # of processor time, in version 1; in version 2, every group has one
_CLOSE_SECONDS = 5.0  # maximum time until the processes of a group have ended
_TICK = 0.005  # s between two attempts to remove a group
_STALE = 3600.0  # s; an empty group that is older was left behind by a grader that was killed
# A shell that joins the groups before `--`, and then executes the command after it.
_ENTER = 'while [ "$1" != -- ]; do echo $$ > "$1"/cgroup.procs || exit 1; shift; done; shift; exec "$@"'


@dataclass(frozen=True)
class ControlGroup:
    """A control group: its folder for each controller."""

    by_controller: dict[str, Path]
    entry_folders: dict[str, Path] = field(default_factory=dict)  # subgroups, if any, that processes enter instead

    @property
    def folders(self) -> tuple[Path, ...]:
        """The group's folders: in version 1, each controller has its own."""
        return tuple(dict.fromkeys(self.by_controller.values()))

    def enter(self, command: list[str]) -> list[str]:
        """Return a command that joins the group and then executes `command`."""
        folders = dict.fromkeys({**self.by_controller, **self.entry_folders}.values())
        return ["sh", "-c", _ENTER, "sh", *map(str, folders), "--", *command] if folders else command

    def is_out_of_memory(self) -> bool:
        """Return whether the kernel has killed a process because the group's memory was used up."""
        folder = self.by_controller.get("memory")
        if folder is None:
            return False
        # In version 2, `memory.events` also counts events in subgroups. But if a sandbox is out of memory, the worker
        # sandbox around it is not.
        events = _read(folder / "memory.events.local") or _read(folder / "memory.events")
        events += _read(folder / "memory.oom_control")
        return any(line.split()[0] == "oom_kill" and line.split()[1] != "0" for line in events.splitlines())

    def close(self) -> None:
        """Kill the remaining processes, and remove the group. If that takes too long, a later `make` removes it."""
        with contextlib.suppress(OSError, KeyError):
            (self.by_controller["pids"] / "pids.max").write_text("0")  # so that a dying process cannot start others
        deadline = time.monotonic() + _CLOSE_SECONDS
        for folder in self.folders:
            while not _remove(folder) and time.monotonic() < deadline:
                for pid in map(int, " ".join(map(_read, folder.rglob("cgroup.procs"))).split()):
                    with contextlib.suppress(OSError):
                        if pid > 0:  # 0 is a process in another pid namespace, but means the caller's group to kill()
                            os.kill(pid, signal.SIGKILL)
                time.sleep(_TICK)


def make(limits: Limits, *, counts_time: bool = False) -> ControlGroup:
    """Return a new group with the limits that this machine supports, possibly none.

    The limits are above `Limits.memory` and `Limits.threads`, so that the watcher notices an excess first, because its
    diagnosis is better. If `counts_time` is true, the group also counts processor time.
    """
    memory = 2 * (limits.memory + limits.scratch)
    values = {"pids": {"pids.max": limits.tasks}, "memory": {"memory.max": memory, "memory.limit_in_bytes": memory}}
    number, folders = next(_NUMBERS), {}
    for controller, values_by_file in {**values, **(_COUNTER if counts_time else {})}.items():
        parent = _parent_folder(controller)
        if parent is None:
            continue
        folder = parent / f"{_NAME}-{_PROCESS}-{number}"
        with contextlib.suppress(OSError):
            folder.mkdir(exist_ok=True)
            for file in (folder / name for name in values_by_file):
                if file.exists():
                    file.write_text(str(values_by_file[file.name]))
                    folders[controller] = folder
            for name, value in (("memory.swap.max", "0"), ("memory.oom.group", "1")):
                if (folder / name).exists():
                    (folder / name).write_text(value)
    return ControlGroup(folders)


def make_nested(limits: Limits, user: int | None) -> ControlGroup:
    """Return a new group whose processes, which run as `user` if given, can create groups for their children.

    The processes cannot change the limits of the new group. It counts their processor time, see `used_seconds`.
    """
    group = make(limits, counts_time=True)
    entry_folders = {}
    for controller, folder in group.by_controller.items():
        subtree_control, leaf = folder / "cgroup.subtree_control", folder / _LEAF
        if subtree_control.exists():  # version 2, in which only a group without subgroups can have processes
            subtree_control.write_text(
                " ".join(f"+{name}" for name, place in group.by_controller.items() if place == folder)
            )
            leaf.mkdir(exist_ok=True)
        for path in (folder, folder / "cgroup.procs", leaf, leaf / "cgroup.procs"):
            if user is not None and path.exists():
                os.chown(path, user, user)
        entry_folders[controller] = leaf if leaf.exists() else folder
    return replace(group, entry_folders=entry_folders)


def used_seconds() -> float | None:
    """Return the processor time, in s, of all processes of this worker sandbox so far; None if no group counts it."""
    file = _time_file()
    if file is None:
        return None
    if file.name == "cpuacct.usage":
        return int(file.read_text()) / 1e9
    return int(dict(line.split() for line in file.read_text().splitlines())["usage_usec"]) / 1e6


@cache
def _time_file() -> Path | None:
    return time_file(_read(Path("/proc/self/mountinfo")))


def time_file(mountinfo: str) -> Path | None:
    """Return the file with the processor time of the worker sandbox in which this process runs, or None.

    A worker sandbox sees nothing but its own group of each controller. So the group itself is a mount only there.
    """
    mounts = (Path(line.split()[4]) for line in mountinfo.splitlines())
    files = (mount / name for mount in mounts for name in ("cpuacct.usage", "cpu.stat"))
    return next((file for file in files if file.parent.name.startswith(f"{_NAME}-") and file.is_file()), None)


def bounds() -> frozenset[str]:
    """Return which of the resources "pids" and "memory" this machine can limit for a whole sandbox."""
    group = make(Limits())
    group.close()
    return frozenset(group.by_controller) | ({"pids"} if os.geteuid() != 0 else set())


@cache
def _parent_folder(controller: str) -> Path | None:
    """Return the folder in which this process can create groups for its children with a controller."""
    for parent in parent_folders(controller, _read(Path("/proc/self/mountinfo")), _read(Path("/proc/self/cgroup"))):
        trial_folder = parent / f"{_NAME}-{_PROCESS}-{next(_NUMBERS)}"
        try:
            trial_folder.mkdir()
        except OSError:
            continue
        completed = subprocess.run(
            ControlGroup({controller: trial_folder}).enter(["true"]), capture_output=True, check=False
        )
        _remove(trial_folder)
        if completed.returncode == 0:
            _remove_stale(parent)
            return parent
    return None


def parent_folders(controller: str, mountinfo: str, memberships: str) -> list[Path]:
    """Return candidates for the folder in which groups with a controller are created, nearest to this process first.

    `mountinfo` and `memberships` are the contents of `/proc/self/mountinfo` and `/proc/self/cgroup`; see
    proc_pid_mountinfo(5) and cgroups(7).
    """
    folders = []
    for line in mountinfo.splitlines():
        before, _, after = line.partition(" - ")
        root, mount = map(Path, before.split()[3:5])  # a worker sandbox sees only its own group, at its usual path
        kind, _, options = after.split(maxsplit=2)
        if kind == "cgroup" and controller in options.split(","):
            place = _below(mount, root, _membership(memberships, controller))
            folders += [folder for folder in _upwards(place, mount) if folder.is_dir()]
        elif kind == "cgroup2":
            place = _below(mount, root, _membership(memberships, ""))
            subtree_control = "cgroup.subtree_control"
            folders += [
                folder for folder in _upwards(place, mount) if controller in _read(folder / subtree_control).split()
            ]
    return folders


def _membership(memberships: str, controller: str) -> str:
    for line in memberships.splitlines():
        _, controllers, path = line.split(":", maxsplit=2)
        if controller in controllers.split(","):
            return path
    return "/"


def _below(mount: Path, root: Path, group: str) -> Path:
    """Return the path of a group below a mount of `root`, or the mount itself if `root` does not contain the group."""
    return mount / Path(group).relative_to(root) if Path(group).is_relative_to(root) else mount


def _upwards(place: Path, mount: Path) -> list[Path]:
    return [folder for folder in (place, *place.parents) if folder.is_relative_to(mount)]


def _remove(folder: Path) -> bool:
    with contextlib.suppress(OSError):
        for subgroup in filter(Path.is_dir, folder.iterdir()):
            _remove(subgroup)  # groups of a worker sandbox that was killed
        folder.rmdir()
    return not folder.exists()


def _remove_stale(parent: Path) -> None:
    for folder in parent.glob(f"{_NAME}-*"):
        with contextlib.suppress(OSError):
            if time.time() - folder.stat().st_mtime > _STALE:
                folder.rmdir()


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:
        return ""
