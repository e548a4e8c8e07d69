"""Where ROS writes its log files: below the user's home, or in a folder that this process has made.

A name in the machine's own temporary folder could be guessed. Who makes such a folder first, closed, lets `rclpy.init`
raise for the user whose name it has; who makes it open reads or changes what that user's nodes log.
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
    """Return a folder for log files of this user's own, made where it was missing.

    It is `$ROS_HOME/log` or `~/.ros/log`, ROS's own. Where that belongs to somebody else, is open to others or cannot
    be made, it is a new folder, the same for this process and all that it starts.
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
