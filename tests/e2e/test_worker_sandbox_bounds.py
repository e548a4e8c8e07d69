"""A program that exceeds its limits ends with its own sandbox, and the worker sandbox around it can still grade."""

from __future__ import annotations

import sys

import pytest

from autograder.run.sandbox import ExitReason, Isolation, cgroup
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox

# `ros2 launch` has the widest limits: its program can have 4,096 threads before the monitor looks.
WORKER = """
import sys
from pathlib import Path
from autograder.run.sandbox import Sandbox
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import LAUNCH
BOMB = '''
import threading, time
threading.stack_size(65536)
try:
    while True:
        threading.Thread(target=time.sleep, args=(60,), daemon=True).start()
except BaseException:
    time.sleep(60)
'''
for _ in range(3):
    with launch([sys.executable, "-I", "-c", BOMB], Sandbox(workdir=Path("/tmp"), limits=LAUNCH)) as process:
        process.wait(60)
        print(process.exit_reason.value, flush=True)
"""


@pytest.mark.skipif("pids" not in cgroup.bounds(), reason="root without control groups: a bomb would stop the machine")
def test_a_bomb_in_the_widest_sandbox_does_not_end_the_worker() -> None:
    report = run_in_worker_sandbox(lambda scratch: [sys.executable, "-c", WORKER], Isolation.BUBBLEWRAP)
    assert (report.exit_reason, report.returncode) == (ExitReason.EXITED, 0), report.output
    assert report.output.split() == [ExitReason.THREADS.value] * 3


FILL_SCRATCH = """
import os, sys
from pathlib import Path
from autograder.run.sandbox.bubblewrap import OUT
scratch = Path(sys.argv[1])
try:
    with open(scratch / "home", "wb") as file:
        while True:
            file.write(bytes(1 << 20))
except OSError as error:
    print(os.strerror(error.errno))
(scratch / OUT / "result.json").write_bytes(bytes(64 << 20))
(Path(os.environ["ROS_LOG_DIR"]).parent / "log").write_text("line")
"""


def test_a_program_that_fills_the_scratch_folder_leaves_room_for_the_result_and_the_log() -> None:
    report = run_in_worker_sandbox(
        lambda scratch: [sys.executable, "-c", FILL_SCRATCH, str(scratch)], Isolation.BUBBLEWRAP
    )
    assert (report.returncode, report.output) == (0, "No space left on device\n")
