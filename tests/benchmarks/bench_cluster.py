"""What a cluster costs beside the gradings: each is replaced by a pause and an answer of usual size.

`python -m tests.benchmarks.bench_cluster SUBMISSIONS THREADS SECONDS` takes other numbers.
"""

from __future__ import annotations

import json
import resource
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

from autograder.checks import suites
from autograder.cluster.connection import LOCAL, connected
from autograder.cluster.dispatch import grade_on
from autograder.cluster.parcel import Answer, Parcel
from autograder.diagnosis import Diagnosis, Kind
from autograder.grading.batch import Request
from autograder.grading.pipeline import refused
from autograder.intake import detect_layout
from autograder.sandbox import Tier

ASSIGNMENT = "02_nodes"
SUBMISSIONS, THREADS = 400, 16
SOURCE = "x = 1\n" * 4000  # 24 kB, as an answer to 02 has


def figures() -> dict[str, float]:
    """Return the milliseconds that a submission costs when its grading takes none."""
    return {"cluster.overhead_ms": round(1000 * seconds(SUBMISSIONS, THREADS, 0.0) / SUBMISSIONS, 2)}


def seconds(submissions: int, threads: int, pause: float) -> float:
    """Return the seconds that a class takes on a worker with as many threads, when each grading takes `pause`."""
    with tempfile.TemporaryDirectory() as name:
        requests = [_request(Path(name), number) for number in range(submissions)]
        with connected(LOCAL, threads, Path(name)) as client:
            grade_on(client, requests[:1], lambda _: None, say=print, grade=partial(_answered, 0.0))  # imports
            began = time.monotonic()
            results = grade_on(client, requests, lambda _: None, say=print, grade=partial(_answered, pause))
            spent = time.monotonic() - began
        assert len({result.submission_sha256 for result in results}) == submissions
        return spent


def _request(folder: Path, number: int) -> Request:
    source = folder / "class" / str(number) / "src" / "package"
    source.mkdir(parents=True)
    (source / "package.xml").write_text(str(number))
    (source / "node.py").write_text(SOURCE)
    return Request(str(number), source.parents[1], ASSIGNMENT, 7, Tier.PROCESS, folder / "out" / str(number))


def _answered(pause: float, data: bytes) -> bytes:
    parcel = Parcel.unpack(data)
    time.sleep(pause)
    result = refused(
        suites.hidden(ASSIGNMENT), "", parcel.seed, parcel.tier, Diagnosis(Kind.BUILD_FAILED, "no", "x" * 4000)
    )
    sha256 = detect_layout(list(parcel.files), ASSIGNMENT).sha256
    return Answer({"result.json": json.dumps(replace(result, submission_sha256=sha256).to_json()).encode()}).pack()


if __name__ == "__main__":
    count, at_once, each = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    spent = seconds(count, at_once, each)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{count} submissions of {each} s, {at_once} threads: {spent:.1f} s, {count * each / spent:.1f} times one")
    print(f"the client used {memory:.0f} MiB at most")
