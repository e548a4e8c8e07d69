"""Grades a class on many machines. Dask sends the submissions to workers that have the same course.

    client: submission -> task (bytes) -> scheduler -> worker: a new sandbox for each submission, as on one machine
    client: verified result and pictures <- reply (bytes) <- scheduler <- worker

`dask worker --preload autograder.grade.cluster` starts a worker, and Dask then calls `dask_setup`.
"""

from __future__ import annotations

import signal
from typing import Any

from autograder.grade.cluster.machine import resources

MAX_WORKER_DEATHS = 2  # after the deaths of this many workers, the submission that they graded is given up


def dask_setup(server: Any) -> None:
    """Prepare a worker or a scheduler of Dask, which calls this when it starts.

    A worker offers a resource for each assignment and isolation level. A scheduler gives up on a submission after two
    workers have died while grading it. Dask's default is four.
    """
    if hasattr(server, "allowed_failures"):
        server.allowed_failures = MAX_WORKER_DEATHS - 1
        return
    if server.nanny:
        # Ctrl-C in a terminal reaches all processes. The nanny decides how its worker reacts.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Large enough for any number of threads, so that only the threads limit how many submissions run at once.
    offered = dict.fromkeys(resources(), float(server.state.nthreads))
    server.state.total_resources.update(offered)
    server.state.available_resources.update(offered)
