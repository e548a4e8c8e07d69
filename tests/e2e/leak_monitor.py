"""Run a grading and find the processes, files, mounts, memory and shared memory that it leaves behind.

The leak monitor is a process with its own scratch folder, shared memory and control group. The kernel makes it the
parent of every orphan among its descendants. It does not see other processes of the machine.
"""

from __future__ import annotations

import ctypes
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import traceback
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from autograder.grade.batch import OnResult, grade_all
from autograder.grade.job import Job, Options
from autograder.grade.parallel import map_parallel
from autograder.grade.pipeline import DEFAULT_SEED, grade_submission
from autograder.run.sandbox import Limits, cgroup
from autograder.run.sandbox.limits import GIB, MIB
from autograder.run.sandbox.procfs import measure, name

ROOT = Path(__file__).resolve().parents[2]
PR_SET_CHILD_SUBREAPER = 36  # prctl(2)


def grade_monitored(folder: Path, assignment: str, submissions: Mapping[str, Path], only: tuple[str, ...] = ()) -> None:
    """Grade submissions by some checks into `folder`/results, and require that nothing else is left behind."""
    folder.mkdir(exist_ok=True, parents=True)
    scratch = tempfile.mkdtemp(prefix="monitor-", dir="/tmp")  # the path of a kernel's sockets must be short
    paths = {student: str(path) for student, path in submissions.items()}
    job = json.dumps({"folder": str(folder), "assignment": assignment, "paths": paths, "only": only})
    # Root's sandboxes run as other users, which do not exist in bubblewrap's user namespace.
    users = ["--unshare-user"] if os.geteuid() else ["--cap-add", "ALL"]
    bubblewrap = ["bwrap", "--die-with-parent", *users, "--unshare-ipc", "--dev-bind", "/", "/"]
    bubblewrap += ["--tmpfs", "/dev/shm", "--tmpfs", scratch, "--chdir", str(ROOT)]
    group = cgroup.make(Limits(memory=32 * GIB, threads=8192))
    command = group.enter([*bubblewrap, "--", sys.executable, "-m", "tests.e2e.leak_monitor", job])
    environment = {**os.environ, "TMPDIR": scratch}
    try:
        completed = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert completed.returncode == 0, completed.stderr
        state = json.loads((folder / "state.json").read_text())
        assert (state["status"], state["after"]) == (0, state["before"]), completed.stderr
        assert [path for controller in group.folders for path in controller.iterdir() if path.is_dir()] == []
        assert _charged_memory(group) < 4 * MIB
    finally:
        group.close()
        Path(scratch).rmdir()


def _charged_memory(group: cgroup.ControlGroup) -> int:
    """Return the bytes that a control group is charged for processes and shared memory; 0 if memory is not counted."""
    folder = group.by_controller.get("memory")
    rows = (folder / "memory.stat").read_text().splitlines() if folder else []
    return sum(int(row.split()[1]) for row in rows if row.split()[0] in ("total_rss", "total_shmem", "anon", "shmem"))


def _grade(folder: str, assignment: str, paths: dict[str, str], only: list[str]) -> None:
    """Grade submissions, two at once."""

    def grade_jobs(jobs: Sequence[Job], on_done: OnResult) -> None:
        part = [replace(job, options=Options(only=tuple(only))) for job in jobs]
        map_parallel(grade_submission, part, jobs=2, on_done=on_done)

    submissions = {student: Path(path) for student, path in paths.items()}
    grade_all(submissions, assignment, seed=DEFAULT_SEED, out=Path(folder, "results"), jobs=2, grade_jobs=grade_jobs)


def _leftovers() -> dict[str, list[str]]:
    """Return everything that a grading could leave behind."""
    queues = (line for kind in ("shm", "sem", "msg") for line in Path("/proc/sysvipc", kind).read_text().splitlines())
    return {
        "processes": [name(pid) for pid in measure(os.getpid()).pids],
        "mounts": Path("/proc/self/mountinfo").read_text().splitlines(),
        "files": [str(path) for path in Path(os.environ["TMPDIR"]).rglob("*")],
        # LTTng, which ROS loads, creates two files for each user, once.
        "shared memory": [*(file for file in os.listdir("/dev/shm") if not file.startswith("lttng-ust-wait")), *queues],
    }


def _monitor(job: dict[str, Any]) -> None:
    """Grade in a child, reap orphaned processes, and record the state before and after."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)
    before = _leftovers()
    if (child := os.fork()) == 0:
        try:
            _grade(**job)
            os._exit(0)
        except BaseException:
            traceback.print_exc()
            os._exit(1)
    reaped = status = 0
    while reaped != child:
        reaped, status = os.wait()
    deadline = time.monotonic() + 30
    while (after := _leftovers()) != before and time.monotonic() < deadline:
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        threading.Event().wait(0.05)
    state = {"status": os.waitstatus_to_exitcode(status), "before": before, "after": after}
    Path(job["folder"], "state.json").write_text(json.dumps(state))


if __name__ == "__main__":
    _monitor(json.loads(sys.argv[1]))
