"""The benchmark of the simulator runs and returns figures."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys

import pytest


@pytest.mark.nightly
def test_the_simulator_benchmark_returns_finite_positive_figures(request: pytest.FixtureRequest) -> None:
    """In a separate process, without ir-sim, which only `make bench` installs."""
    measure = "print(json.dumps(figures(1, 1, 0.2, compare=False)))"
    script = f"import json; from tests.benchmarks.bench_sim import figures; {measure}"
    environment = {**os.environ, "PYTHONPATH": str(request.config.rootpath)}
    completed = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True
    )
    figures = json.loads(completed.stdout.splitlines()[-1])
    assert {
        "sim.scan360_numpy_us",
        "sim.scan360_numba_us",
        "sim.scan1080_numpy_us",
        "sim.scan1080_numba_us",
        "sim.index_cost_ratio",
        "sim.loop_numpy_rtf",
        "sim.loop_numba_rtf",
        "sim.contact_numpy_rtf",
        "sim.contact_numba_rtf",
    } <= set(figures)
    assert all(math.isfinite(value) and value > 0 for value in figures.values())
