"""The service in a process of its own, which kills itself, as `kill -9` does, before a chosen line of its code.

All of it is the real code, but for the worker in the sandbox, which has tests of its own.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any

from autograder.grade import grade_submission
from autograder.grade.job import Job
from autograder.lms.serve import service
from autograder.lms.serve.grading import Way
from autograder.lms.serve.settings import read_settings
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.worker_sandbox import WorkerReport
from tests.unit.cli.killed_grading import Worker

OWN = str(Path(service.__file__).parent)
ORDER, HOLD = "order", "hold"  # files beside the folder of the data


def serve(
    settings: Path,
    data: Path,
    environment: Mapping[str, str],
    *,
    lines: Any = None,
    kill_at: int = -1,
    hold: bool = False,
    jobs: int = 1,
) -> None:
    """Serve as `autograder serve` does.

    The file `order` beside the data gets the students in the order in which they are graded.

    Args:
        settings: the file of settings.
        data: the folder of the data.
        environment: what the hub tells its service.
        lines: a shared number, which counts the lines of the service's code that were run; None to count none.
        kill_at: the number of the line before which the process kills itself, from 0; -1 for none.
        hold: whether gradings wait until there is a file `hold` beside the data.
        jobs: how many are graded at once.
    """
    os.environ.update(environment)
    worker = Worker(defaultdict(tuple))

    def run(job: Job) -> WorkerReport:
        if hold:
            wait((data.parent / HOLD).exists, 120.0)
        with (data.parent / ORDER).open("a") as order:
            order.write(f"{job.student}\n")
        return worker(job)

    if lines is not None:
        trace = _tracer(lines, kill_at)
        threading.settrace(trace)
        sys.settrace(trace)
    way = Way(jobs, 7, Isolation.PROCESS, partial(grade_submission, run_job=run))
    service.serve(read_settings(settings), data, way, service.address(environment))


def _tracer(lines: Any, kill_at: int) -> Any:
    def count(frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line":
            if lines.value == kill_at:
                os.kill(os.getpid(), signal.SIGKILL)
            lines.value += 1
        return count

    return lambda frame, event, argument: count if frame.f_code.co_filename.startswith(OWN) else None


def wait(is_there: Callable[[], bool], patience: float) -> None:
    """Wait until something is so; fail after `patience` seconds."""
    end = time.monotonic() + patience
    while not is_there():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)
