"""Chooses where ROS writes its log files: below the user's home, or in a folder that this process has created.

A fixed name in the machine's temporary folder could be guessed. Another user who creates that folder first can make
`rclpy.init` raise an error, or read and change the logs.
"""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path


def log_folder(environ: Mapping[str, str] | None = None) -> Path:
    """Return a private folder for this user's log files, and create it if it does not exist.

    This is ROS's default folder, `$ROS_HOME/log` or `~/.ros/log`. If that belongs to another user, is writable by
    others or cannot be created, a temporary folder is created once per process.
    """
    environ = os.environ if environ is None else environ
    home = environ.get("ROS_HOME") or environ.get("HOME", "")
    if home.startswith("/"):
        folder = Path(home, "log" if environ.get("ROS_HOME") else ".ros/log")
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            if _is_private(folder):
                return folder
    return _temporary_folder()


def _is_private(folder: Path) -> bool:
    status = folder.stat()
    # The group may have write access: on Ubuntu, it is the user's own.
    return status.st_uid == os.geteuid() and not status.st_mode & stat.S_IWOTH and os.access(folder, os.W_OK | os.X_OK)


@cache
def _temporary_folder() -> Path:
    return Path(tempfile.mkdtemp(prefix="ros2-log-"))
