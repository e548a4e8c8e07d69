"""The reference of the capstone graded again and again: all points each time, and the same traces to the last bit?

    python -m tests.benchmarks.repeat_capstone -n 200

The first half is graded by as many at once as the machine has cores; the second half under load: three for each. A
trace is the fingerprint of a run in a hidden world: what the robot sensed, was told and did, at every instant. Exit
status: 0 when all gradings agree.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from autograder.checks import suites
from autograder.grading import grade_submission
from autograder.proof.mutants import write_reference
from autograder.result import Outcome

ASSIGNMENT = "08_capstone"
SEED = 2026
CROWD = 3


@dataclass(frozen=True)
class Grading:
    """One grading: its percentage, what was lost, each hidden run's fingerprint, how long it took, among how many."""

    percent: float
    lost: tuple[str, ...]
    traces: dict[str, str]
    seconds: float
    at_once: int


def grade(folder: Path, at_once: int, number: int) -> Grading:
    """Grade the reference in `folder`."""
    began = time.monotonic()
    out = folder / str(number)
    result = grade_submission(folder / "reference", ASSIGNMENT, student="reference", seed=SEED, out=out)
    traces = {artifact.name: artifact.sha256[:16] for artifact in result.artifacts}
    lost = tuple(f"{check.id}: {check.message}" for check in result.checks if check.outcome is not Outcome.PASSED)
    return Grading(100.0 * result.score / result.max_score, lost, traces, time.monotonic() - began, at_once)


def gradings(folder: Path, times: int) -> Iterator[Grading]:
    """Yield the gradings as they come: the first half on a machine that has room for them, the others under load."""
    cores = os.cpu_count() or 1
    half = range(1, times // 2 + 1)
    for numbers, at_once in ((half, cores), (range(half.stop, times + 1), CROWD * cores)):
        with ThreadPoolExecutor(at_once) as pool:
            pending = [pool.submit(grade, folder, at_once, number) for number in numbers]
            for done in as_completed(pending):
                yield done.result()


def main() -> int:
    """Grade it as often as the command line says; say what differs."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.repeat_capstone", description="See above.")
    parser.add_argument("-n", type=int, default=10, metavar="N", help="how often (default: 10)")
    times = parser.parse_args().n
    first: dict[str, str] = {}
    alike = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_reference(suites.hidden(ASSIGNMENT).packages, folder / "reference")
        for number, grading in enumerate(gradings(folder, times), 1):
            first = first or grading.traces
            different = sorted({file for file, _ in grading.traces.items() ^ first.items()})
            alike += grading.percent == 100.0 and bool(grading.traces) and not different
            said = f"differs in {', '.join(different)}" if different else "the same traces"
            took = f"{grading.at_once} at once: {grading.seconds:5.1f} s"
            print(
                f"{number:4} of {times}, {took}, {grading.percent:g} %, {said}", *grading.lost, sep="\n  ", flush=True
            )
    print(f"{alike} of {times} with all points and the same traces: {first}")
    return 0 if alike == times else 1


if __name__ == "__main__":
    sys.exit(main())
