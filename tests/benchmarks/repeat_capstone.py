"""Grade the reference of the capstone many times: each time must give full marks and the same traces, bit for bit.

    make capstones TIMES=1000

The first half runs one grading for each core at a time; the second half runs three for each core, under load. A trace
is the fingerprint of a run in a hidden world: the robot's scans, commands and motion at every step.

Each grading is a line of a file. An interrupted run continues where it stopped, unless the checks or the grader have
changed. Exit status: 0 when all gradings agree.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.course_paths import ROOT
from autograder.grade import grade_submission
from autograder.grade.job import Job
from autograder.suite import Outcome, suites

ASSIGNMENT = "08_capstone"
SEED = 2026
CROWD = 3  # parallel gradings for each core, under load
REPORT = ROOT / ".build" / "capstones.jsonl"


@dataclass(frozen=True)
class Grading:
    """One grading: its percentage, failed checks, traces and duration, and the number of parallel gradings."""

    version: str  # the version of the checks and the grader
    number: int
    at_once: int  # parallel gradings
    percent: float
    lost: tuple[str, ...]  # failed checks, each with its message
    traces: dict[str, str]
    seconds: float


def stored(report: Path, version: str) -> dict[int, Grading]:
    """Return the gradings of one version in a report, by their numbers. An incomplete line is ignored."""
    gradings_by_number = {}
    for line in report.read_text().splitlines() if report.is_file() else ():
        try:
            grading = Grading(**{**(data := json.loads(line)), "lost": tuple(data["lost"])})
        except (ValueError, TypeError, KeyError):
            continue
        if grading.version == version:
            gradings_by_number[grading.number] = grading
    return gradings_by_number


def cut_off(report: Path) -> bool:
    """Return whether the last line of a report lacks its line feed, so that the next line would be appended to it."""
    return report.is_file() and report.read_bytes()[-1:] not in (b"", b"\n")


def grade(folder: Path, version: str, at_once: int, number: int) -> Grading:
    """Grade the reference in `folder`."""
    start = time.monotonic()
    result = grade_submission(Job(folder / "reference", ASSIGNMENT, "reference", SEED, folder / str(number)))
    traces = {artifact.name: artifact.sha256[:16] for artifact in result.artifacts}
    lost = tuple(f"{check.id}: {check.message}" for check in result.checks if check.outcome is not Outcome.PASSED)
    percent, seconds = 100.0 * result.score / result.max_score, time.monotonic() - start
    return Grading(version, number, at_once, percent, lost, traces, round(seconds, 2))


def gradings(folder: Path, version: str, times: int, stored_gradings: dict[int, Grading]) -> Iterator[Grading]:
    """Yield the remaining gradings: the first half with a core for each, the others under load."""
    cores = os.cpu_count() or 1
    first_half = range(1, times // 2 + 1)
    for numbers, at_once in ((first_half, cores), (range(first_half.stop, times + 1), CROWD * cores)):
        with ThreadPoolExecutor(at_once) as pool:
            pending = [
                pool.submit(grade, folder, version, at_once, number)
                for number in numbers
                if number not in stored_gradings
            ]
            try:
                for future in as_completed(pending):
                    yield future.result()
            finally:
                pool.shutdown(cancel_futures=True)


def main() -> int:
    """Grade the reference the given number of times, and report the differences."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.repeat_capstone", description="See above.")
    parser.add_argument("-n", type=int, default=10, metavar="N", help="how often (default: 10)")
    parser.add_argument("--report", type=Path, default=REPORT, help=f"default: {REPORT.relative_to(ROOT)}")
    args = parser.parse_args()
    if args.n < 1:
        parser.error("-n must be 1 or more")
    version = suites.hidden(ASSIGNMENT).version
    gradings_by_number = {
        number: grading for number, grading in stored(args.report, version).items() if number <= args.n
    }
    print(f"checks and grader {version}: {len(gradings_by_number)} of {args.n} are graded", flush=True)
    args.report.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name, args.report.open("a") as report:
        report.write("\n" if cut_off(args.report) else "")
        write_reference(suites.hidden(ASSIGNMENT).packages, Path(name) / "reference")
        for grading in gradings(Path(name), version, args.n, dict(gradings_by_number)):
            report.write(json.dumps(asdict(grading)) + "\n")
            report.flush()
            gradings_by_number[grading.number] = grading
            duration = f"{grading.at_once} at once: {grading.seconds:5.1f} s"
            print(
                f"{len(gradings_by_number):4} of {args.n}, {duration}, {grading.percent:g} %",
                *grading.lost,
                sep="\n  ",
                flush=True,
            )
    return summarise(list(gradings_by_number.values()))


def summarise(all_gradings: list[Grading]) -> int:
    """Report how many gradings agree, and describe how each of the others differs. Return the exit status."""
    first = all_gradings[0].traces
    others = [
        grading for grading in all_gradings if grading.percent != 100.0 or not grading.traces or grading.traces != first
    ]
    for grading in others:
        different_traces = ", ".join(sorted({name for name, _ in grading.traces.items() ^ first.items()}))
        print(f"number {grading.number}: {grading.percent:g} %, other traces: {different_traces or 'none'}")
    print(f"{len(all_gradings) - len(others)} of {len(all_gradings)} with all points and the same traces: {first}")
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
