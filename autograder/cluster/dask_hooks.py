"""What `dask worker --preload autograder.cluster` and `dask scheduler --preload autograder.cluster` set up."""

from __future__ import annotations

import signal
from typing import Any

from autograder.cluster.machine import resources

DEATHS = 2  # workers that a submission may take with it


def dask_setup(server: Any) -> None:
    """Prepare a worker or a scheduler of Dask, which calls this when it starts.

    A worker offers a resource for each assignment and tier. A scheduler gives a submission up when two workers have
    died with it; Dask's own default is four.
    """
    if hasattr(server, "allowed_failures"):
        server.allowed_failures = DEATHS - 1
        return
    if server.nanny:
        # Ctrl-C in a terminal reaches all processes. The nanny decides what its worker does then.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    # As many as there are threads: the number of threads alone says how many submissions are graded at once.
    offered = dict.fromkeys(resources(), float(server.state.nthreads))
    server.state.total_resources.update(offered)
    server.state.available_resources.update(offered)
