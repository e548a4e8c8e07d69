"""Bounds that the kernel keeps on a whole sandbox: how many processes it has, and how much memory of any kind.

Anybody but root is bounded by `prlimit --nproc`, too. The kernel never applies it to the machine's root (setrlimit(2),
RLIMIT_NPROC), and a fork bomb outgrows anything that only watches it. Memory that no process has mapped (files in
memory, buffers of sockets, inodes) is counted by nothing else. See cgroups(7); version 1 and version 2.
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
_PROCESS = os.urandom(6).hex()  # worker sandboxes have process ids of their own, and some share a folder
_NAME = "autograder"
_LEAF = "worker"
_CLOSE_SECONDS = 5.0
_TICK = 0.005
_STALE = 3600.0  # s after which an empty group was left by a grader that was killed
# A shell that joins the groups before `--`, and then executes the command after it.
_ENTER = 'while [ "$1" != -- ]; do echo $$ > "$1"/cgroup.procs || exit 1; shift; done; shift; exec "$@"'


@dataclass(frozen=True)
class ControlGroup:
    """A group of processes that are counted, by the folder of each controller."""

    by_controller: dict[str, Path]
    entered: dict[str, Path] = field(default_factory=dict)  # the group below it that is entered in its place, if any

    @property
    def folders(self) -> tuple[Path, ...]:
        """The group's folders: with version 1, each controller has its own."""
        return tuple(dict.fromkeys(self.by_controller.values()))

    def enter(self, command: list[str]) -> list[str]:
        """Return `command`, run as a member of the group from its first moment."""
        folders = dict.fromkeys({**self.by_controller, **self.entered}.values())
        return ["sh", "-c", _ENTER, "sh", *map(str, folders), "--", *command] if folders else command

    def ran_out(self) -> bool:
        """Return whether the kernel has ended a process because the group's memory was used up."""
        folder = self.by_controller.get("memory")
        if folder is None:
            return False
        # In version 2, `memory.events` also counts events in the groups below. A worker sandbox is not out of memory
        # because a sandbox in it is.
        events = _read(folder / "memory.events.local") or _read(folder / "memory.events")
        events += _read(folder / "memory.oom_control")
        return any(line.split()[0] == "oom_kill" and line.split()[1] != "0" for line in events.splitlines())

    def close(self) -> None:
        """Kill the rest of the group, and remove it. If it is not empty after 5 s, a later `make` removes it."""
        with contextlib.suppress(OSError, KeyError):
            (self.by_controller["pids"] / "pids.max").write_text("0")  # a dying process has no more children
        deadline = time.monotonic() + _CLOSE_SECONDS
        for folder in self.folders:
            while not _removed(folder) and time.monotonic() < deadline:
                for pid in map(int, " ".join(map(_read, folder.rglob("cgroup.procs"))).split()):
                    with contextlib.suppress(OSError):
                        if pid > 0:  # 0 is one of another pid namespace, and to kill() the caller's whole group
                            os.kill(pid, signal.SIGKILL)
                time.sleep(_TICK)


def make(limits: Limits) -> ControlGroup:
    """Return a new group with the bounds that this machine supports, possibly none.

    The bounds are above `Limits.memory` and `Limits.threads`, so that the watcher, whose diagnosis is better, notices
    an excess first.
    """
    memory = 2 * (limits.memory + limits.scratch)
    values = {"pids": {"pids.max": limits.tasks}, "memory": {"memory.max": memory, "memory.limit_in_bytes": memory}}
    number, folders = next(_NUMBERS), {}
    for controller, files in values.items():
        home = _home(controller)
        if home is None:
            continue
        folder = home / f"{_NAME}-{_PROCESS}-{number}"
        with contextlib.suppress(OSError):
            folder.mkdir(exist_ok=True)
            for file in (folder / name for name in files):
                if file.exists():
                    file.write_text(str(files[file.name]))
                    folders[controller] = folder
            for name, value in (("memory.swap.max", "0"), ("memory.oom.group", "1")):
                if (folder / name).exists():
                    (folder / name).write_text(value)
    return ControlGroup(folders)


def make_nested(limits: Limits, user: int | None) -> ControlGroup:
    """Return a new group in which its processes create groups for their children. `user` runs them, if not this user.

    The bounds of the new group stay out of their reach.
    """
    group = make(limits)
    entered = {}
    for controller, folder in group.by_controller.items():
        handed_down, inner = folder / "cgroup.subtree_control", folder / _LEAF
        if handed_down.exists():  # version 2, where only a group without groups has processes
            handed_down.write_text(
                " ".join(f"+{name}" for name, place in group.by_controller.items() if place == folder)
            )
            inner.mkdir(exist_ok=True)
        for path in (folder, folder / "cgroup.procs", inner, inner / "cgroup.procs"):
            if user is not None and path.exists():
                os.chown(path, user, user)
        entered[controller] = inner if inner.exists() else folder
    return replace(group, entered=entered)


def bounds() -> frozenset[str]:
    """Return which resources this machine can limit for all processes of a sandbox together: pids, memory."""
    group = make(Limits())
    group.close()
    return frozenset(group.by_controller) | ({"pids"} if os.geteuid() != 0 else set())


@cache
def _home(controller: str) -> Path | None:
    """Return the folder in which this process can make groups of a controller, and have its children join them."""
    for home in homes(controller, _read(Path("/proc/self/mountinfo")), _read(Path("/proc/self/cgroup"))):
        trial = home / f"{_NAME}-{_PROCESS}-{next(_NUMBERS)}"
        try:
            trial.mkdir()
        except OSError:
            continue
        entered = subprocess.run(ControlGroup({controller: trial}).enter(["true"]), capture_output=True, check=False)
        _removed(trial)
        if entered.returncode == 0:
            _sweep(home)
            return home
    return None


def homes(controller: str, mountinfo: str, own: str) -> list[Path]:
    """Return the folders in which a group with a controller may be made, nearest to this process first.

    `mountinfo` and `own` are what `/proc/self/mountinfo` and `/proc/self/cgroup` say, see proc_pid_mountinfo(5) and
    cgroups(7).
    """
    folders = []
    for line in mountinfo.splitlines():
        before, _, after = line.partition(" - ")
        root, mount = map(Path, before.split()[3:5])  # a worker sandbox sees its own group alone, at its usual place
        kind, _, options = after.split(maxsplit=2)
        if kind == "cgroup" and controller in options.split(","):
            place = _below(mount, root, _own(own, controller))
            folders += [folder for folder in _upwards(place, mount) if folder.is_dir()]
        elif kind == "cgroup2":
            place = _below(mount, root, _own(own, ""))
            handed_down = "cgroup.subtree_control"
            folders += [
                folder for folder in _upwards(place, mount) if controller in _read(folder / handed_down).split()
            ]
    return folders


def _own(cgroups: str, controller: str) -> str:
    for line in cgroups.splitlines():
        _, controllers, path = line.split(":", maxsplit=2)
        if controller in controllers.split(","):
            return path
    return "/"


def _below(mount: Path, root: Path, group: str) -> Path:
    """Return the path of a group below a mount that shows `root`, or the mount itself if the mount does not show it."""
    return mount / Path(group).relative_to(root) if Path(group).is_relative_to(root) else mount


def _upwards(place: Path, mount: Path) -> list[Path]:
    return [folder for folder in (place, *place.parents) if folder.is_relative_to(mount)]


def _removed(folder: Path) -> bool:
    with contextlib.suppress(OSError):
        for below in filter(Path.is_dir, folder.iterdir()):
            _removed(below)  # groups of a worker sandbox that was killed
        folder.rmdir()
    return not folder.exists()


def _sweep(home: Path) -> None:
    for folder in home.glob(f"{_NAME}-*"):
        with contextlib.suppress(OSError):
            if time.time() - folder.stat().st_mtime > _STALE:
                folder.rmdir()


def _read(path: Path) -> str:
    try:
        return path.read_text()
    except OSError:
        return ""
