"""Sends a class to the workers of a scheduler, and takes in what comes back.

Only as many submissions are under way as the workers have threads. So the memory of client and scheduler does not grow
with the class, and after Ctrl-C there is little to wait for.
"""

from __future__ import annotations

import contextlib
import queue
import signal
import threading
import time
import uuid
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

from distributed import Client, Future

from autograder.exceptions import StudentError
from autograder.grade.answer import AnswerError
from autograder.grade.batch import OnResult
from autograder.grade.cluster import MAX_WORKER_DEATHS, work
from autograder.grade.cluster.accept import accept
from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.cluster.machine import difference, resource
from autograder.grade.cluster.parcel import Parcel
from autograder.grade.job import Job
from autograder.grade.pipeline import not_graded, refused
from autograder.grade.store import write_result
from autograder.submission.intake import read_files
from autograder.submission.intake.files import digest

TICK = 0.5  # s between two looks at the workers
NO_WORKER_TIMEOUT_SECONDS = 120.0  # real time without a worker that can grade this
TRIES = 2  # answers that are asked for before a submission is given up

Grade = Callable[[bytes], bytes]


@dataclass(frozen=True)
class _Pending:
    """A submission that a worker grades, its digest, and how often it was sent."""

    job: Job
    sha256: str
    parcel: bytes
    tries: int = 1


def grade_on(
    client: Client,
    jobs: Sequence[Job],
    on_result: OnResult,
    *,
    report: Callable[[str], None],
    grade: Grade = work.grade,
) -> None:
    """Grade submissions of one assignment on a cluster.

    After Ctrl-C nothing more is sent, and the results of what was sent are stored. A second Ctrl-C drops these, too.

    Args:
        client: the connection to the scheduler.
        jobs: submissions of one assignment and tier.
        on_result: called for each result as it comes, in any order.
        report: called with a sentence for each worker that is refused, which says why.
        grade: what a worker does with a packed `Parcel`; it returns a packed `Answer`.

    Raises:
        ClusterError: the scheduler was lost, or no worker can grade this. What came by then is stored.
    """
    if not jobs:
        return
    dispatch = _Dispatch(client, jobs, on_result, report, grade)
    try:
        with _first_interrupt() as interrupted:
            dispatch.run(interrupted)
    finally:
        dispatch.forget()
    if interrupted.is_set():
        raise KeyboardInterrupt


@contextlib.contextmanager
def _first_interrupt() -> Iterator[threading.Event]:
    """Yield an event that the first Ctrl-C sets; the second one raises KeyboardInterrupt.

    Python drops an exception that comes in a finalizer, and futures of Dask have one. So the first raises none.
    """
    noted = threading.Event()

    def note(*_: object) -> None:
        noted.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield noted
    finally:
        signal.signal(signal.SIGINT, before)


class _Dispatch:
    """The state of grading one class on the cluster."""

    def __init__(
        self,
        client: Client,
        jobs: Sequence[Job],
        on_result: OnResult,
        report: Callable[[str], None],
        grade: Grade,
    ) -> None:
        self._client, self._on_result, self._report, self._grade = client, on_result, report, grade
        self._resource = resource(jobs[0].assignment, jobs[0].tier)
        self._refused: set[str] = set()
        self._threads = 0
        self._looked = float("-inf")
        self._fitted = time.monotonic()
        self._parcels = self._packed(jobs)
        self._under_way: dict[Future, _Pending] = {}
        self._ended: queue.SimpleQueue[Future] = queue.SimpleQueue()

    def run(self, interrupted: threading.Event) -> None:
        """Send and take in until nothing is left; once interrupted, take in what is under way."""
        left = True
        while left or self._under_way:
            left = left and not interrupted.is_set()
            while left and len(self._under_way) < self._fitting_threads():
                pending = next(self._parcels, None)
                if pending is None:
                    left = False
                else:
                    self._send(pending)
            self._take()

    def forget(self) -> None:
        """Let the scheduler drop what is under way."""
        with contextlib.suppress(Exception):  # the scheduler may be what was lost
            self._client.cancel(list(self._under_way), force=True)

    def _fitting_threads(self) -> int:
        """Return how many submissions the workers that fit can grade at once; look at them now and then."""
        now = time.monotonic()
        if now - self._looked >= TICK:
            self._look()
            self._looked = now
            if self._threads:
                self._fitted = now
            elif now - self._fitted > NO_WORKER_TIMEOUT_SECONDS:
                raise ClusterError(
                    f"for {NO_WORKER_TIMEOUT_SECONDS:.0f} s there was no worker that can grade this: start one with "
                    "`dask worker ADDRESS --preload autograder.grade.cluster`"
                )
        return self._threads

    def _look(self) -> None:
        """Count the threads of the workers that fit; report once of each other why it is refused."""
        try:
            workers = self._client.scheduler_info()["workers"]
        except (OSError, RuntimeError, TimeoutError) as error:
            raise ClusterError(f"the scheduler does not answer: {error}") from None
        self._threads = 0
        for address, worker in workers.items():
            why = difference(self._resource, worker["resources"])
            if not why:
                self._threads += worker["nthreads"]
            elif address not in self._refused:
                self._refused.add(address)
                self._report(f"The worker {address} is refused: {why}.")

    def _packed(self, jobs: Sequence[Job]) -> Iterator[_Pending]:
        """Yield what has to be sent; report the results of what intake refuses."""
        for job in jobs:
            try:
                files = read_files(job.path, job.assignment)
            except StudentError as error:
                self._on_result(write_result(job, refused(job, error.diagnosis), {}))
                continue
            yield _Pending(job, digest(files), Parcel(job, tuple(files)).pack())

    def _send(self, pending: _Pending) -> None:
        future = self._client.submit(
            self._grade, pending.parcel, key=f"grade-{uuid.uuid4()}", resources={self._resource: 1}, pure=False
        )
        self._under_way[future] = pending
        future.add_done_callback(self._ended.put)

    def _take(self) -> None:
        """Wait a moment for a future that has ended, and take it in."""
        try:
            future = self._ended.get(timeout=TICK)
        except queue.Empty:
            self._fitting_threads()  # has the scheduler or the last worker gone?
            return
        pending = self._under_way.pop(future)
        if future.status == "cancelled":
            raise ClusterError("the connection to the scheduler was lost")
        if future.status == "error":
            why = f"The {MAX_WORKER_DEATHS} workers that had this submission died."
            self._give_up(pending.job, why, f"{future.exception()!r}\n")
            return
        try:
            self._on_result(accept(future.result(), pending.job, pending.sha256))
        except AnswerError as error:
            if pending.tries < TRIES:
                self._send(replace(pending, tries=pending.tries + 1))
                return
            why = f"Workers failed on this submission {TRIES} times."
            self._give_up(pending.job, why, f"{error}\n")

    def _give_up(self, job: Job, why: str, log: str) -> None:
        self._on_result(write_result(job, *not_graded(job, why, log)))
