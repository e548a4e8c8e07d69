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

MARK = "made by make hub"  # in the comment of each user that was made here: others are never touched


@contextmanager
def temporary_users(homes: Path, password: str, groups: Mapping[str, Sequence[str]]) -> Iterator[None]:
    """Make groups and their users, with homes below `homes`; remove them in the end, with their processes and homes.

    Remains of a killed trial are removed first.

    Raises:
        UsageError: a user of that name was there before.
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
    """Remove those users and groups that were made here, if they are there.

    Raises:
        UsageError: a user of that name was not made here.
    """
    for group, names in groups.items():
        for name in names:
            with contextlib.suppress(KeyError):
                user = pwd.getpwnam(name)
                if user.pw_gecos != MARK:
                    raise UsageError(f"there is a user {name} on this machine already, who was not made by make hub")
                _kill_processes(user.pw_uid)
                _run("userdel", "--remove", name)
        with contextlib.suppress(KeyError):
            grp.getgrnam(group)
            _run("groupdel", group)


def _kill_processes(uid: int) -> None:
    """Kill all processes of a user: kernels outlive a server that was killed."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if process.stat().st_uid == uid:
                os.kill(int(process.name), signal.SIGKILL)


def _run(*command: str, text: str = "") -> None:
    done = subprocess.run(command, cwd="/", input=text, text=True, capture_output=True, check=False)
    # 12: userdel could not remove a mail spool or a home that is not there
    if done.returncode not in (0, 12):
        raise UsageError(f"{' '.join(command)}: {done.stderr.strip() or done.returncode}")
