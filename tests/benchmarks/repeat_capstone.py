"""The reference of the capstone graded again and again: all points each time, and the same traces to the last bit?

    python -m tests.benchmarks.repeat_capstone -n 200

Every second time, busy processes take the machine's cores. A trace is the fingerprint of a run in a hidden world: what
the robot sensed, was told and did, at every instant. Exit status: 0 when all gradings agree.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from autograder import suites
from autograder.grading import grade_submission
from autograder.suites.mutants import lay_down_reference

ASSIGNMENT = "08_capstone"
SEED = 2026


def graded(folder: Path, number: int) -> tuple[float, dict[str, str]]:
    """Grade the reference in `folder`; return its percentage, and the fingerprint of each hidden run."""
    out = folder / str(number)
    result = grade_submission(folder / "reference", ASSIGNMENT, student="reference", seed=SEED, out=out).result
    return 100.0 * result.score / result.max_score, {a.name: a.sha256[:16] for a in result.artifacts}


@contextmanager
def busy(cores: int) -> Iterator[None]:
    """Keep cores busy meanwhile."""
    command = [sys.executable, "-I", "-S", "-c", "while True: pass"]
    processes = [subprocess.Popen(command) for _ in range(cores)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def main() -> int:
    """Grade it as often as the command line says; say what differs."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.repeat_capstone", description="See above.")
    parser.add_argument("-n", type=int, default=10, metavar="N", help="how often (default: 10)")
    times = parser.parse_args().n
    first: dict[str, str] = {}
    alike = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        lay_down_reference(suites.load(ASSIGNMENT).packages, folder / "reference")
        for number in range(1, times + 1):
            load = (os.cpu_count() or 1) if number % 2 == 0 else 0
            began = time.monotonic()
            with busy(load):
                percent, traces = graded(folder, number)
            first = first or traces
            different = sorted({file for file, _ in traces.items() ^ first.items()})
            alike += percent == 100.0 and bool(traces) and not different
            said = f"differs in {', '.join(different)}" if different else "the same traces"
            took = f"{time.monotonic() - began:5.1f} s"
            print(f"{number:4} of {times}, {load} busy: {took}, {percent:g} %, {said}", flush=True)
    print(f"{alike} of {times} with all points and the same traces: {first}")
    return 0 if alike == times else 1


if __name__ == "__main__":
    sys.exit(main())
