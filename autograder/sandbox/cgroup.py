"""A bound that the kernel keeps on how many processes a sandbox has, where the grader runs as root.

`prlimit --nproc` bounds everybody else. The kernel never applies it to the machine's root (setrlimit(2),
RLIMIT_NPROC), and a fork bomb outgrows anything that only watches it. So root's sandboxes get a control group with the
kernel's pids controller (cgroups(7); version 1 and version 2).
"""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

_NUMBERS = itertools.count()
_NAME = "autograder"
_PATIENCE = 5.0
_TICK = 0.005
_STALE = 3600.0  # s after which an empty group was left by a grader that was killed


@dataclass(frozen=True)
class ControlGroup:
    """One control group of processes that are counted."""

    folder: Path

    def enter(self, command: list[str]) -> list[str]:
        """Return `command`, run as a member of the group from its first moment."""
        return ["sh", "-c", 'echo $$ > "$0"/cgroup.procs && exec "$@"', str(self.folder), *command]

    def close(self) -> None:
        """Kill what is left of the group, and remove it; one that is not empty after 5 s is left to a later `make`."""
        deadline = time.monotonic() + _PATIENCE
        with contextlib.suppress(OSError):
            (self.folder / "pids.max").write_text("0")  # who is about to die has no more children
        while True:
            try:
                return self.folder.rmdir()
            except OSError:
                if time.monotonic() > deadline:
                    return None
            for pid in map(int, _read(self.folder / "cgroup.procs").split()):
                with contextlib.suppress(OSError):
                    if pid > 0:  # 0 is one of another pid namespace, and to kill() the caller's whole group
                        os.kill(pid, signal.SIGKILL)
            time.sleep(_TICK)


def make(most: int) -> ControlGroup | None:
    """Return a new group of at most `most` processes and threads; None where it is not needed, or cannot be had."""
    if os.geteuid() != 0:
        return None
    for home in homes(_read(Path("/proc/self/mountinfo")), _read(Path("/proc/self/cgroup"))):
        folder = home / f"{_NAME}-{os.getpid()}-{next(_NUMBERS)}"
        try:
            folder.mkdir()
            (folder / "pids.max").write_text(str(most))
        except OSError:
            with contextlib.suppress(OSError):
                folder.rmdir()
            continue
        _sweep(home)
        return ControlGroup(folder)
    return None


def bounded() -> bool:
    """Return whether this machine bounds how many processes a sandbox of this user has."""
    if os.geteuid() != 0:
        return True
    group = make(1)
    if group is not None:
        group.close()
    return group is not None


def homes(mountinfo: str, own: str) -> list[Path]:
    """Return the folders in which a group with the pids controller can be made, nearest to this process first.

    `mountinfo` and `own` are what `/proc/self/mountinfo` and `/proc/self/cgroup` say, see proc_pid_mountinfo(5) and
    cgroups(7).
    """
    found = []
    for line in mountinfo.splitlines():
        before, _, after = line.partition(" - ")
        mount = Path(before.split()[4])
        kind, _, options = after.split(maxsplit=2)
        if kind == "cgroup" and "pids" in options.split(","):
            place = mount / _own(own, "pids")
            found += [folder for folder in _upwards(place, mount) if folder.is_dir()]
        elif kind == "cgroup2":
            place = mount / _own(own, "")
            handed_down = "cgroup.subtree_control"
            found += [folder for folder in _upwards(place, mount) if "pids" in _read(folder / handed_down).split()]
    return found


def _own(cgroups: str, controller: str) -> str:
    for line in cgroups.splitlines():
        _, controllers, path = line.split(":", maxsplit=2)
        if controller in controllers.split(","):
            return path.lstrip("/")
    return ""


def _upwards(place: Path, mount: Path) -> list[Path]:
    return [folder for folder in (place, *place.parents) if folder.is_relative_to(mount)]


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
