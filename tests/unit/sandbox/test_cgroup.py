"""Where a control group can be made, told from the kernel's own tables; and one made for real."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from autograder.sandbox import cgroup

NEEDED = pytest.mark.skipif(
    os.geteuid() != 0 or not cgroup.bounded(), reason="not root, or no control group can be made"
)


def _hierarchy(root: Path, *folders: str) -> None:
    for folder in folders:
        (root / folder).mkdir(parents=True)


def test_version_1_offers_the_own_group_of_the_pids_controller_and_those_above(tmp_path: Path) -> None:
    _hierarchy(tmp_path, "pids/user/session", "memory/other")
    mountinfo = (
        f"33 31 0:30 / {tmp_path}/memory rw,relatime - cgroup cgroup rw,memory\n"
        f"39 31 0:36 / {tmp_path}/pids rw,relatime - cgroup cgroup rw,pids\n"
    )
    own = "9:name=systemd:/\n8:pids:/user/session\n4:memory:/other\n0::/\n"
    pids = tmp_path / "pids"
    assert cgroup.homes(mountinfo, own) == [pids / "user" / "session", pids / "user", pids]


def test_version_2_offers_the_groups_that_hand_the_pids_controller_down(tmp_path: Path) -> None:
    _hierarchy(tmp_path, "user.slice/session.scope")
    (tmp_path / "cgroup.subtree_control").write_text("cpu memory pids\n")
    (tmp_path / "user.slice" / "cgroup.subtree_control").write_text("memory pids\n")
    (tmp_path / "user.slice" / "session.scope" / "cgroup.subtree_control").write_text("\n")
    mountinfo = f"31 23 0:28 / {tmp_path} rw,nosuid - cgroup2 cgroup2 rw,nsdelegate\n"
    assert cgroup.homes(mountinfo, "0::/user.slice/session.scope\n") == [tmp_path / "user.slice", tmp_path]


def test_without_control_groups_there_is_no_home() -> None:
    assert cgroup.homes("23 1 0:21 / /proc rw - proc proc rw\n", "") == []


def test_a_user_other_than_root_needs_no_group(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert cgroup.make(10) is None
    assert cgroup.bounded()


def test_a_root_that_can_make_no_group_is_not_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    monkeypatch.setattr(cgroup, "homes", lambda mountinfo, own: [Path("/proc/nowhere")])
    assert cgroup.make(10) is None
    assert not cgroup.bounded()


@NEEDED
def test_the_kernel_refuses_one_process_too_many_and_nothing_stays(tmp_path: Path) -> None:
    group = cgroup.make(4)
    assert group is not None
    script = "for n in 1 2 3 4 5; do sleep 30 >&- 2>&- & done; echo all of them"
    done = subprocess.run(group.enter(["sh", "-c", script]), capture_output=True, text=True, timeout=20, check=False)
    assert "all of them" not in done.stdout
    assert "fork" in done.stderr.lower()
    left = (group.folder / "cgroup.procs").read_text().split()
    assert left
    group.close()
    assert not group.folder.exists()
    assert not [pid for pid in left if Path(f"/proc/{pid}/cmdline").is_file() and _runs(pid)]


def _runs(pid: str) -> bool:
    return b"sleep" in Path(f"/proc/{pid}/cmdline").read_bytes()


@NEEDED
def test_a_group_left_by_a_grader_that_was_killed_is_swept(monkeypatch: pytest.MonkeyPatch) -> None:
    left = cgroup.make(4)
    assert left is not None
    monkeypatch.setattr(cgroup, "_STALE", -1.0)
    group = cgroup.make(4)
    assert group is not None
    assert not left.folder.exists()
    group.close()
