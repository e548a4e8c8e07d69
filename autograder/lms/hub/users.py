"""Creates users and groups of this machine for a trial hub, and removes them with all their files."""

from __future__ import annotations

import contextlib
import grp
import os
import pwd
import signal
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from autograder.exceptions import UsageError

MARK = "made by make hub"  # the comment (GECOS field) of each user that this module created; it removes no others


@contextmanager
def temporary_users(homes: Path, password: str, groups: Mapping[str, Sequence[str]]) -> Iterator[None]:
    """Create groups and their users, with home folders in `homes`. Afterwards, remove them with all their processes.

    Users and groups that a killed trial left behind are removed first.

    Raises:
        UsageError: another user has one of the names.
    """
    remove_users(groups)
    try:
        for group, names in groups.items():
            _run("groupadd", group)
            for name in names:
                home = ("--create-home", "--home-dir", str(homes / name), "--key", "HOME_MODE=0700")
                _run("useradd", *home, "--shell", "/bin/bash", "--comment", MARK, "--groups", group, name)
                _run("chpasswd", text=f"{name}:{password}\n")
        yield
    finally:
        remove_users(groups)


def remove_users(groups: Mapping[str, Sequence[str]]) -> None:
    """Remove groups and their users, with the home folders, if they exist.

    Raises:
        UsageError: a user with one of the names was not created by this module.
    """
    for group, names in groups.items():
        for name in names:
            with contextlib.suppress(KeyError):
                user = pwd.getpwnam(name)
                if user.pw_gecos != MARK:
                    raise UsageError(f"this machine has another user {name}, not made by make hub: rename or remove it")
                _kill_processes(user.pw_uid)
                _run("userdel", "--remove", name)
        with contextlib.suppress(KeyError):
            grp.getgrnam(group)
            _run("groupdel", group)


def _kill_processes(uid: int) -> None:
    """Kill all processes of a user, because kernels survive if their server is killed."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if process.stat().st_uid == uid:
                os.kill(int(process.name), signal.SIGKILL)


def _run(*command: str, text: str = "") -> None:
    completed = subprocess.run(command, cwd="/", input=text, text=True, capture_output=True, check=False)
    # 12: userdel found no mail spool or home folder to remove
    if completed.returncode not in (0, 12):
        raise UsageError(f"{' '.join(command)}: {completed.stderr.strip() or completed.returncode}")
