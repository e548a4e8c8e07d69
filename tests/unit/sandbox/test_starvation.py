"""Time that a submission's own processes use does not count as used by others."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import pytest

from autograder.run.sandbox import Isolation, Limits, cgroup
from autograder.run.sandbox.procfs import TICK, CpuTime, ThreadTime
from autograder.run.sandbox.starvation import CpuUse, measure_use, starved_seconds, used_seconds
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox

MAIN, CHILD = 11, 12  # process ids, and MAIN's thread


def can_count_time() -> bool:
    """Return whether this machine has a control group that counts the processor time of a worker sandbox."""
    group = cgroup.make(Limits(), counts_time=True)
    files = [folder / name for folder in group.folders for name in ("cpuacct.usage", "cpu.stat")]
    is_counted = any(file.is_file() for file in files)
    group.close()
    return is_counted


@pytest.mark.parametrize(
    ("child", "expected"),
    [(0.0, 0.6), (0.2, 0.4), (0.6, 0.0), (9.0, 0.0)],
    ids=["others had the processor", "a child had it for a part", "a child had it", "many children had many"],
)
def test_time_that_the_submission_s_other_processes_used_is_subtracted_from_a_wait(
    child: float, expected: float
) -> None:
    before = CpuUse({MAIN: ThreadTime(1.0, 2.0)}, {MAIN: CpuTime(1.0), CHILD: CpuTime(3.0)})
    after = CpuUse({MAIN: ThreadTime(1.3, 2.6)}, {MAIN: CpuTime(1.3), CHILD: CpuTime(3.0 + child)})
    assert max(0.0, starved_seconds(before, after)) == pytest.approx(expected)


def test_children_that_have_ended_are_counted_once() -> None:
    before = CpuUse({}, {MAIN: CpuTime(1.0, 5.0), CHILD: CpuTime(3.0)})
    assert used_seconds(before, CpuUse({}, {MAIN: CpuTime(1.0, 8.5)})) == pytest.approx(0.5)


def test_an_unreaped_process_does_not_reduce_the_time_of_the_others() -> None:
    before = CpuUse({}, {MAIN: CpuTime(1.0), CHILD: CpuTime(3.0)})
    assert used_seconds(before, CpuUse({}, {MAIN: CpuTime(1.4)})) == pytest.approx(0.4)


def test_the_time_of_a_started_process_and_of_its_children_is_found_after_their_end() -> None:
    busy = "import time\nwhile time.process_time() < 0.2: pass"
    parent = f"import subprocess, sys\nsubprocess.run([sys.executable, '-c', {busy!r}])"
    before = measure_use(())
    subprocess.run([sys.executable, "-c", parent], check=True)
    assert used_seconds(before, measure_use(())) > 0.2 - 2 * TICK


def test_time_that_a_control_group_has_counted_is_used_instead_of_that_of_processes() -> None:
    before, after = CpuUse({}, {MAIN: CpuTime(1.0)}, total=4.0), CpuUse({}, {MAIN: CpuTime(1.5)}, total=7.0)
    assert used_seconds(before, after) == pytest.approx(3.0)
    assert used_seconds(replace(before, total=None), after) == pytest.approx(0.5)


BURN = """
import os, signal, time
signal.signal(signal.SIGCHLD, signal.SIG_IGN)
for _ in range(4):
    if os.fork() == 0:
        while time.process_time() < 0.2: pass
        os._exit(0)
try:
    os.wait()  # returns when no child is left
except ChildProcessError:
    pass
"""
MEASURE = f"""
import subprocess, sys
from autograder.run.sandbox.starvation import measure_use, used_seconds
before = measure_use(())
subprocess.run([sys.executable, "-c", {BURN!r}], check=True)
print(used_seconds(before, measure_use(())))
"""


@pytest.mark.skipif(not can_count_time(), reason="no control group that counts processor time can be made")
def test_the_time_of_children_for_which_their_parent_does_not_wait_is_known_with_a_control_group() -> None:
    report = run_in_worker_sandbox(lambda scratch: [sys.executable, "-c", MEASURE], Isolation.BUBBLEWRAP)
    assert float(report.output) > 4 * 0.2 - 8 * TICK, report.output


def test_without_processes_nothing_is_starved() -> None:
    assert starved_seconds(CpuUse({}, {}), CpuUse({}, {})) == 0.0
