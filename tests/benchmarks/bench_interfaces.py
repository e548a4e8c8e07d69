"""Measures the cost of a loadable package of a message, a service and an action: built, cached, and by colcon."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from autograder.interfaces import Cache
from autograder.interfaces.definitions import KINDS
from autograder.interfaces.prefix import build
from autograder.proof.mutants import write_reference

PACKAGE = "my_robot_interfaces"
RUNS = 3


def figures() -> dict[str, float]:
    """Return seconds and, where there is something to compute, core-seconds: medians of several runs, colcon's of one.

    `interface.cold_*` builds, `interface.cached_s` finds what was built, `interface.colcon_*` is `colcon build`.
    """
    cold: list[tuple[float, float]] = []
    cached: list[tuple[float, float]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_reference((PACKAGE,), folder)
        source = folder / "src" / PACKAGE
        texts = {f"{kind}/{path.name}": path.read_text() for kind in KINDS for path in (source / kind).iterdir()}
        for run in range(RUNS):
            for costs in (cold, cached):
                cache = Cache(folder / "cache" / str(run))
                costs.append(_cost(lambda cache=cache: build(PACKAGE, texts, cache=cache)))  # type: ignore[misc]
        colcon = _cost(lambda: _colcon(folder))
    return {
        "interface.cold_s": round(statistics.median(seconds for seconds, _ in cold), 3),
        "interface.cold_core_s": round(statistics.median(spent for _, spent in cold), 3),
        "interface.cached_s": round(statistics.median(seconds for seconds, _ in cached), 4),
        "interface.colcon_s": round(colcon[0], 3),
        "interface.colcon_core_s": round(colcon[1], 3),
    }


def _colcon(folder: Path) -> None:
    subprocess.run([sys.executable, "-m", "autograder", "ros", "colcon", "build"], cwd=folder, check=True, stdout=2)


def _cost(work: Callable[[], object]) -> tuple[float, float]:
    """Return the seconds and the core-seconds that something takes, with all processes that it starts."""
    began, before = time.perf_counter(), _spent()
    work()
    return time.perf_counter() - began, _spent() - before


def _spent() -> float:
    spent = os.times()
    return spent.user + spent.system + spent.children_user + spent.children_system
