"""ROS's log folder belongs to the user: no other user can create it first or write to it."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pytest

from autograder.ros import RosEnvironment
from autograder.ros.log_folder import log_folder

ROS = RosEnvironment("wheels", (Path("/venv"),), Path("/venv/lib/rclpy"))


def test_logs_go_below_the_user_s_home_under_names_that_no_other_user_can_take(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shared_tmp = tmp_path / "tmp"
    shared_tmp.mkdir()
    (shared_tmp / f"ros2-log-{os.getuid()}").write_text("a victim's folder, made first")
    monkeypatch.setattr(tempfile, "tempdir", str(shared_tmp))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("ROS_HOME", raising=False)
    folder = Path(ROS.variables()["ROS_LOG_DIR"])
    assert folder == tmp_path / "home" / ".ros" / "log"
    assert folder.is_dir()
    assert log_folder({"ROS_HOME": str(tmp_path / "ros")}) == tmp_path / "ros" / "log"


@pytest.mark.parametrize("home", ["open", "closed", "missing"])
def test_a_new_folder_is_created_if_others_can_use_the_home_s_folder(tmp_path: Path, home: str) -> None:
    environ = {"HOME": str(tmp_path)} if home != "missing" else {}
    if home == "open":
        (tmp_path / ".ros" / "log").mkdir(parents=True)
        (tmp_path / ".ros" / "log").chmod(0o777)
    if home == "closed":
        (tmp_path / ".ros").write_text("in the way")
    folder = log_folder(environ)
    assert not folder.is_relative_to(tmp_path / ".ros")
    assert folder.stat().st_uid == os.geteuid()
    assert folder.stat().st_mode & 0o077 == 0
    assert log_folder(environ) == folder
