"""Measure and draw how much faster more workers grade a class, for docs/cluster.md.

`python -m tests.benchmarks.cluster_scale RESULTS` takes the durations of gradings from stored results. A pause of such
a duration replaces each grading, so that 64 workers fit on any machine. The workers are Dask workers, each with its
own connection, in one process with the scheduler. `... draw` redraws stored measurements.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from distributed import LocalCluster

from autograder.grade.cluster.connection import PRELOAD, connected
from autograder.report.export import load
from tests.benchmarks.bench_cluster import time_class

MEASUREMENTS = Path(__file__).parents[2] / "docs" / "scale.json"
WORKERS = (1, 4, 16, 64)
SUBMISSIONS = 5000  # for 64 workers; fewer workers get fewer, so that all clusters take equally long


def main(results: str) -> None:
    """Measure all clusters at the same time, which is possible because they only wait, and draw the result."""
    if results != "draw":
        pauses = [result.seconds for result in load(Path(results))]
        commands = [[sys.executable, "-m", __spec__.name, json.dumps(pauses), str(workers)] for workers in WORKERS]
        processes = [subprocess.Popen(command, stdout=subprocess.PIPE) for command in commands]
        measurements = [json.loads(process.communicate()[0]) for process in processes]
        figures = {"cores": os.cpu_count(), "pauses": sorted(set(pauses)), "measured": measurements}
        MEASUREMENTS.write_text(json.dumps(figures, indent=1) + "\n")
    draw()


def measure(pauses: list[float], workers: int) -> dict[str, float]:
    """Return the figures of one cluster."""
    serve = [sys.executable, "-m", __spec__.name, "serve", str(workers)]
    with subprocess.Popen(serve, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as cluster:
        assert cluster.stdout is not None
        address = cluster.stdout.readline().strip()
        with connected(address, 0, Path()) as client:
            client.wait_for_workers(workers)
            submissions = SUBMISSIONS * workers // WORKERS[-1]
            elapsed, work_seconds = time_class(client, submissions, pauses)
        cluster.communicate()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {
        "workers": workers,
        "submissions": submissions,
        "seconds": round(elapsed, 1),
        "speed_up": round(work_seconds / elapsed, 2),
        "client_mib": round(memory),
    }


def serve(workers: int) -> None:
    """Run a cluster until standard input ends."""
    options = {"preload": [PRELOAD]}
    with LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        dashboard_address=None,
        memory_limit=None,
        scheduler_kwargs=options,
        **options,
    ) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()


def draw() -> None:
    """Draw the speed-up beside the ideal one."""
    measurements = json.loads(MEASUREMENTS.read_text())["measured"]
    workers = [point["workers"] for point in measurements]
    plt.rcParams["svg.hashsalt"] = "scale"
    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    axes.plot(workers, workers, "--", color="0.6", label="as many times as there are workers")
    axes.plot(workers, [point["speed_up"] for point in measurements], "o-", color="#005a8c", label="measured")
    axes.set(xscale="log", yscale="log", xlabel="workers", ylabel="times as fast as one worker", xticks=workers)
    axes.set(yticks=workers, xticklabels=workers, yticklabels=workers)
    axes.minorticks_off()
    axes.legend()
    figure.savefig(MEASUREMENTS.with_suffix(".svg"), metadata={"Date": None})


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        serve(int(sys.argv[2]))
    elif len(sys.argv) == 3:
        print(json.dumps(measure(json.loads(sys.argv[1]), int(sys.argv[2]))))
    else:
        main(sys.argv[1])
