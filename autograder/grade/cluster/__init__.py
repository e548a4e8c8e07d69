"""Grades a class on many machines: the same gradings, sent by Dask to workers that grade with the same course.

    client: a class -> a parcel each (bytes) -> scheduler -> worker: a cell of its own, as on one machine
    client: result and pictures, checked as a stranger's <- an answer (bytes) <- worker

`dask worker --preload autograder.grade.cluster` is a worker; Dask calls `dask_setup` when it starts.
"""

from __future__ import annotations

import signal
from typing import Any

from autograder.grade.cluster.machine import resources

MAX_WORKER_DEATHS = 2  # workers that may die while they grade one submission


def dask_setup(server: Any) -> None:
    """Prepare a worker or a scheduler of Dask, which calls this when it starts.

    A worker offers a resource for each assignment and tier. A scheduler gives a submission up when two workers have
    died with it; Dask's own default is four.
    """
    if hasattr(server, "allowed_failures"):
        server.allowed_failures = MAX_WORKER_DEATHS - 1
        return
    if server.nanny:
        # Ctrl-C in a terminal reaches all processes. The nanny decides what its worker does then.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    # As many as there are threads: the number of threads alone says how many submissions are graded at once.
    offered = dict.fromkeys(resources(), float(server.state.nthreads))
    server.state.total_resources.update(offered)
    server.state.available_resources.update(offered)
