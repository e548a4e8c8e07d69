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
    """Return a private folder for this user's log files, which is created if it does not exist.

    It is ROS's default, `$ROS_HOME/log` or `~/.ros/log`. If that belongs to another user, is open to others or cannot
    be created, it is a new folder, the same for this process and its children.
    """
    environ = os.environ if environ is None else environ
    home = environ.get("ROS_HOME") or environ.get("HOME", "")
    if home.startswith("/"):
        folder = Path(home, "log" if environ.get("ROS_HOME") else ".ros/log")
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            if _is_ours(folder):
                return folder
    return _fresh()


def _is_ours(folder: Path) -> bool:
    status = folder.stat()
    # The group may be the user's own, as on Ubuntu.
    return status.st_uid == os.geteuid() and not status.st_mode & stat.S_IWOTH and os.access(folder, os.W_OK | os.X_OK)


@cache
def _fresh() -> Path:
    return Path(tempfile.mkdtemp(prefix="ros2-log-"))
