"""Grades a class on many machines: the same gradings, sent by Dask to workers that grade with the same course.

    client: a class -> a parcel each (bytes) -> scheduler -> worker: a cell of its own, as on one machine
    client: result and pictures, checked as a stranger's <- an answer (bytes) <- worker

`dask worker --preload autograder.cluster` is a worker; Dask calls `dask_setup` when it starts.
"""

from autograder.cluster.dask_hooks import dask_setup

__all__ = ["dask_setup"]
