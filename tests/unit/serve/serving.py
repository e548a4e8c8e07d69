"""The service in a separate process, which kills itself, as `kill -9` does, before a chosen line of its code.

All of its code is real except for the worker in the sandbox, which has tests of its own.
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
from autograder.lms.serve.grading import GradingOptions
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
        lines: a shared counter of executed lines of the service's code; None to count none.
        kill_at: the index of the executed line before which the process kills itself; -1 for none.
        hold: whether gradings wait until the file `hold` exists beside the data.
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
    options = GradingOptions(jobs, 7, Isolation.PROCESS, partial(grade_submission, run_job=run))
    service.serve(read_settings(settings), data, options, service.address(environment))


def _tracer(lines: Any, kill_at: int) -> Any:
    def count(frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line":
            if lines.value == kill_at:
                os.kill(os.getpid(), signal.SIGKILL)
            lines.value += 1
        return count

    return lambda frame, event, argument: count if frame.f_code.co_filename.startswith(OWN) else None


def wait(condition: Callable[[], bool], patience: float) -> None:
    """Wait until the condition holds; fail after `patience` seconds."""
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, "the condition never held"
        time.sleep(0.02)
