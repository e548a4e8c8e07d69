"""How long a message, a service and an action take to become a loadable package: built, and from the cache."""

from __future__ import annotations

import statistics
import tempfile
import time
from pathlib import Path

from autograder.interfaces import Cache, build

FILES = {
    "msg/Status.msg": "std_msgs/Header header\nstring name\nint32 level\nbool is_charging\nfloat32[] joints\n",
    "srv/Ask.srv": "int32 a\n---\nbool ok\nStatus status\n",
    "action/Go.action": "float64 distance\n---\nfloat64 driven\n---\nfloat64 left\n",
}
RUNS = 3


def figures() -> dict[str, float]:
    """Return `interface.cold_s` and `interface.cached_s`, medians of several runs."""
    cold, cached = [], []
    with tempfile.TemporaryDirectory() as folder:
        for run in range(RUNS):
            root = Path(folder) / str(run)
            for seconds in (cold, cached):
                cache = Cache(root)
                began = time.perf_counter()
                build("bench_interfaces", FILES, cache=cache)
                seconds.append(time.perf_counter() - began)
                cache.release()
    return {
        "interface.cold_s": round(statistics.median(cold), 3),
        "interface.cached_s": round(statistics.median(cached), 4),
    }
