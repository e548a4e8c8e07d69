"""Where a control group can be created, according to the kernel's tables, and real control groups."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.run.sandbox import ExitReason, Limits, Process, cgroup
from autograder.run.sandbox.limits import MIB

NEEDED = pytest.mark.skipif(
    os.geteuid() != 0 or "pids" not in cgroup.bounds(), reason="not root, or no control group can be made"
)


def _hierarchy(root: Path, *folders: str) -> None:
    for folder in folders:
        (root / folder).mkdir(parents=True)


def test_version_1_offers_the_process_s_group_of_the_pids_controller_and_those_above(tmp_path: Path) -> None:
    _hierarchy(tmp_path, "pids/user/session", "memory/other")
    mountinfo = (
        f"33 31 0:30 / {tmp_path}/memory rw,relatime - cgroup cgroup rw,memory\n"
        f"39 31 0:36 / {tmp_path}/pids rw,relatime - cgroup cgroup rw,pids\n"
    )
    memberships = "9:name=systemd:/\n8:pids:/user/session\n4:memory:/other\n0::/\n"
    pids = tmp_path / "pids"
    assert cgroup.parent_folders("pids", mountinfo, memberships) == [pids / "user" / "session", pids / "user", pids]


def test_version_2_offers_the_groups_that_delegate_the_pids_controller(tmp_path: Path) -> None:
    _hierarchy(tmp_path, "user.slice/session.scope")
    (tmp_path / "cgroup.subtree_control").write_text("cpu memory pids\n")
    (tmp_path / "user.slice" / "cgroup.subtree_control").write_text("memory pids\n")
    (tmp_path / "user.slice" / "session.scope" / "cgroup.subtree_control").write_text("\n")
    mountinfo = f"31 23 0:28 / {tmp_path} rw,nosuid - cgroup2 cgroup2 rw,nsdelegate\n"
    assert cgroup.parent_folders("pids", mountinfo, "0::/user.slice/session.scope\n") == [
        tmp_path / "user.slice",
        tmp_path,
    ]


def test_without_control_groups_no_folder_is_offered() -> None:
    assert cgroup.parent_folders("pids", "23 1 0:21 / /proc rw - proc proc rw\n", "") == []


@pytest.fixture(autouse=True)
def _uncached_parent_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cgroup, "_parent_folder", cgroup._parent_folder.__wrapped__)


@pytest.mark.parametrize(("user", "bounds"), [(0, set()), (1000, {"pids"})])
def test_without_a_control_group_prlimit_bounds_all_users_but_root(
    monkeypatch: pytest.MonkeyPatch, user: int, bounds: set[str]
) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: user)
    monkeypatch.setattr(cgroup, "parent_folders", lambda controller, mountinfo, memberships: [Path("/proc/nowhere")])
    group = cgroup.make(Limits())
    assert group.folders == ()
    assert group.enter(["true"]) == ["true"]
    assert not group.is_out_of_memory()
    assert cgroup.bounds() == bounds


def test_a_group_of_version_2_is_one_folder_with_both_bounds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No controller acts on this folder. The test only asserts which texts are written to its files."""
    monkeypatch.setattr(cgroup, "_parent_folder", lambda controller: tmp_path)
    folder = tmp_path / f"autograder-{cgroup._PROCESS}-7"
    folder.mkdir()
    for name in ("pids.max", "memory.max", "memory.swap.max", "memory.oom.group"):
        (folder / name).touch()
    monkeypatch.setattr(cgroup, "_NUMBERS", iter([7]))
    group = cgroup.make(Limits(threads=10, memory=100 * MIB, scratch=28 * MIB))
    assert group.folders == (folder,)
    texts = {path.name: path.read_text() for path in folder.iterdir()}
    expected = {"pids.max": "40", "memory.max": str(256 * MIB), "memory.swap.max": "0", "memory.oom.group": "1"}
    assert texts == expected
    (folder / "memory.events").write_text("low 0\noom 1\noom_kill 0\n")
    assert not group.is_out_of_memory()
    (folder / "memory.events").write_text("low 0\noom 1\noom_kill 1\n")
    assert group.is_out_of_memory()


def test_a_worker_sandbox_with_version_2_has_a_group_beside_those_of_its_inner_sandboxes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The kernel forbids a group with both processes and subgroups. This folder only imitates a control group."""
    monkeypatch.setattr(cgroup, "_parent_folder", lambda controller: tmp_path)
    monkeypatch.setattr(cgroup, "_NUMBERS", iter([7]))
    folder = tmp_path / f"autograder-{cgroup._PROCESS}-7"
    _hierarchy(folder, "worker")
    for name in ("pids.max", "memory.max", "cgroup.procs", "cgroup.subtree_control", "worker/cgroup.procs"):
        (folder / name).touch()
    group = cgroup.make_nested(Limits(), os.geteuid())
    assert (folder / "cgroup.subtree_control").read_text() == "+pids +memory"
    completed = subprocess.run(group.enter(["sh", "-c", "echo $$"]), capture_output=True, text=True, check=True)
    assert (
        folder / "worker" / "cgroup.procs"
    ).read_text() == completed.stdout  # one process, which entered and then ran
    assert (folder / "cgroup.procs").read_text() == ""


@pytest.mark.parametrize(("name", "text"), [("cpuacct.usage", "2500000000\n"), ("cpu.stat", "usage_usec 2500000\n")])
def test_the_processor_time_of_a_worker_sandbox_is_read_in_both_versions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str
) -> None:
    memory, own = tmp_path / "autograder-0123456789ab-6", tmp_path / "autograder-0123456789ab-7"
    _hierarchy(tmp_path, "other", memory.name, own.name)
    for folder in (tmp_path / "other", own):
        (folder / name).write_text(text)
    lines = [f"40 31 0:30 /a {folder} rw - cgroup cgroup rw\n" for folder in (tmp_path / "other", memory, own)]
    assert cgroup.time_file("".join(lines[:2])) is None
    assert cgroup.time_file("".join(lines)) == own / name
    monkeypatch.setattr(cgroup, "_time_file", lambda: own / name)
    assert cgroup.used_seconds() == 2.5


@pytest.mark.skipif("memory" not in cgroup.bounds(), reason="no control group of memory can be made")
def test_memory_that_no_process_has_mapped_is_bounded(tmp_path: Path) -> None:
    code = "import os, time; f = os.memfd_create('m'); [os.write(f, bytes(1 << 20)) for _ in range(200)]; print('all')"
    limits = Limits(memory=30 * MIB, scratch=10 * MIB)
    with Process([sys.executable, "-c", code], limits, group=(group := cgroup.make(limits))) as outer:
        assert outer.wait(60)
    assert "all" in outer.output  # nothing has entered the group
    with Process((group := cgroup.make(limits)).enter([sys.executable, "-c", code]), limits, group=group) as inner:
        assert inner.wait(60)
    assert (inner.exit_reason, "all" in inner.output) == (ExitReason.MEMORY, False)
    assert not any(folder.exists() for folder in group.folders)


@NEEDED
def test_the_kernel_refuses_one_process_too_many_and_no_process_is_left(tmp_path: Path) -> None:
    group = cgroup.make(Limits(threads=1))
    script = "for n in 1 2 3 4 5; do sleep 30 >&- 2>&- & done; echo all of them"
    completed = subprocess.run(
        group.enter(["sh", "-c", script]), capture_output=True, text=True, timeout=20, check=False
    )
    assert "all of them" not in completed.stdout
    assert "fork" in completed.stderr.lower()
    pids = (group.by_controller["pids"] / "cgroup.procs").read_text().split()
    assert pids
    group.close()
    assert not any(folder.exists() for folder in group.folders)
    assert not [pid for pid in pids if Path(f"/proc/{pid}/cmdline").is_file() and _runs(pid)]


def _runs(pid: str) -> bool:
    return b"sleep" in Path(f"/proc/{pid}/cmdline").read_bytes()


@NEEDED
def test_a_control_group_left_by_a_killed_grader_is_removed(monkeypatch: pytest.MonkeyPatch) -> None:
    left_group = cgroup.make(Limits())
    monkeypatch.setattr(cgroup, "_STALE", -1.0)
    group = cgroup.make(Limits())
    assert not any(folder.exists() for folder in left_group.folders)
    group.close()


def test_a_group_does_not_count_memory_events_of_its_subgroups(tmp_path: Path) -> None:
    group = cgroup.ControlGroup({"memory": tmp_path})
    (tmp_path / "memory.events").write_text("oom 1\noom_kill 1\n")
    assert group.is_out_of_memory()
    (tmp_path / "memory.events.local").write_text("oom 0\noom_kill 0\n")
    assert not group.is_out_of_memory()
