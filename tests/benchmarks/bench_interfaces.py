"""Measure the cost of a package with a message, a service and an action: as plain classes, and built by colcon."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from autograder.author.verification.mutants import write_reference
from autograder.building.interfaces.definitions import KINDS
from autograder.building.interfaces.loading import Texts, classes
from autograder.ros import activate

PACKAGE = "my_robot_interfaces"
RUNS = 3


def figures() -> dict[str, float]:
    """Return seconds and core-seconds: the medians of several runs or, for colcon, the costs of one run.

    `interface.cold_*` makes the classes and their type supports, `interface.cached_s` finds them in the cache, and
    `interface.colcon_*` is `colcon build`.
    """
    activate()
    cold_costs: list[tuple[float, float]] = []
    cached_costs: list[tuple[float, float]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_reference((PACKAGE,), folder)
        source = folder / "src" / PACKAGE
        paths = sorted(path for kind in KINDS for path in (source / kind).iterdir())
        texts = tuple((f"{path.parent.name}/{path.name}", path.read_text()) for path in paths)
        for _ in range(RUNS):
            classes.cache_clear()
            for costs in (cold_costs, cached_costs):
                costs.append(_cost(lambda: _make(texts)))
        colcon = _cost(lambda: _colcon(folder))
    return {
        "interface.cold_s": round(statistics.median(seconds for seconds, _ in cold_costs), 3),
        "interface.cold_core_s": round(statistics.median(core_seconds for _, core_seconds in cold_costs), 3),
        "interface.cached_s": round(statistics.median(seconds for seconds, _ in cached_costs), 7),
        "interface.colcon_s": round(colcon[0], 3),
        "interface.colcon_core_s": round(colcon[1], 3),
    }


def _make(texts: Texts) -> None:
    """Make the classes and the type supports that rclpy needs."""
    package = classes(((PACKAGE, texts),))
    action: Any = package.action.DriveDistance
    services = (package.srv.CheckTrip, action.Impl.SendGoalService, action.Impl.GetResultService)
    for kind in (package.msg.RobotStatus, action.Impl.FeedbackMessage, *services):
        type(kind).__import_type_support__()


def _colcon(folder: Path) -> None:
    subprocess.run([sys.executable, "-m", "autograder", "ros", "colcon", "build"], cwd=folder, check=True, stdout=2)


def _cost(work: Callable[[], object]) -> tuple[float, float]:
    """Return the seconds and core-seconds of a function, including all processes that it starts."""
    start, before = time.perf_counter(), _cpu_seconds()
    work()
    return time.perf_counter() - start, _cpu_seconds() - before


def _cpu_seconds() -> float:
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
