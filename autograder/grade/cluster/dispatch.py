"""Sends the submissions of a class to the workers of a scheduler and collects their results.

No more submissions are in progress than the workers have threads. The memory of client and scheduler therefore does not
grow with the class, and the wait after Ctrl-C is short.
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
from autograder.grade.batch import OnResult
from autograder.grade.cluster import MAX_WORKER_DEATHS, work
from autograder.grade.cluster.accept import accept
from autograder.grade.cluster.exceptions import ClusterError
from autograder.grade.cluster.machine import difference, resource
from autograder.grade.cluster.task import Task
from autograder.grade.job import Job
from autograder.grade.pipeline import not_graded_result, unclear_result
from autograder.grade.reply import ReplyError
from autograder.grade.store import write_result
from autograder.submission.intake import read_files
from autograder.submission.intake.files import digest

TICK = 0.5  # s between polls of the workers
NO_WORKER_TIMEOUT_SECONDS = 120.0  # real time to wait for a worker that can grade the assignment
TRIES = 2  # attempts to grade a submission

Grade = Callable[[bytes], bytes]


@dataclass(frozen=True)
class _Pending:
    """A submission in progress, its digest, its packed task, and how often it was sent."""

    job: Job
    sha256: str
    task: bytes
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

    After Ctrl-C no more submissions are sent, and the pending results are stored. A second Ctrl-C discards them.

    Args:
        client: the connection to the scheduler.
        jobs: submissions of one assignment and isolation level.
        on_result: called with each result when it arrives, in any order.
        report: called with the reason for each rejected worker, as a sentence.
        grade: the worker's function, which takes a packed `Task` and returns a packed `Reply`.

    Raises:
        ClusterError: the scheduler was lost, or no worker can grade this assignment. Earlier results are stored.
    """
    if not jobs:
        return
    dispatch = _Dispatch(client, jobs, on_result, report, grade)
    try:
        with _first_interrupt() as interrupted:
            dispatch.run(interrupted)
    finally:
        dispatch.cancel()
    if interrupted.is_set():
        raise KeyboardInterrupt


@contextlib.contextmanager
def _first_interrupt() -> Iterator[threading.Event]:
    """Yield an event that the first Ctrl-C sets. The second one raises KeyboardInterrupt.

    Python ignores exceptions raised in a finalizer, and Dask's futures have one. The first Ctrl-C therefore raises
    nothing.
    """
    interrupted = threading.Event()

    def on_interrupt(*_: object) -> None:
        interrupted.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    previous_handler = signal.signal(signal.SIGINT, on_interrupt)
    try:
        yield interrupted
    finally:
        signal.signal(signal.SIGINT, previous_handler)


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
        self._resource = resource(jobs[0].assignment, jobs[0].isolation)
        self._rejected_addresses: set[str] = set()
        self._threads = 0
        self._last_poll_time = float("-inf")
        self._last_suitable_time = time.monotonic()
        self._queue = self._pending_submissions(jobs)
        self._in_progress: dict[Future, _Pending] = {}
        self._finished_futures: queue.SimpleQueue[Future] = queue.SimpleQueue()

    def run(self, interrupted: threading.Event) -> None:
        """Send submissions and receive results until all are done. After an interrupt, only receive."""
        has_more = True
        while has_more or self._in_progress:
            has_more = has_more and not interrupted.is_set()
            while has_more and len(self._in_progress) < self._suitable_threads():
                pending = next(self._queue, None)
                if pending is None:
                    has_more = False
                else:
                    self._send(pending)
            self._receive()

    def cancel(self) -> None:
        """Tell the scheduler to cancel the submissions in progress."""
        with contextlib.suppress(Exception):  # the scheduler may be lost
            self._client.cancel(list(self._in_progress), force=True)

    def _suitable_threads(self) -> int:
        """Return how many submissions the suitable workers can grade at once. Poll the workers every `TICK` seconds."""
        now = time.monotonic()
        if now - self._last_poll_time >= TICK:
            self._poll()
            self._last_poll_time = now
            if self._threads:
                self._last_suitable_time = now
            elif now - self._last_suitable_time > NO_WORKER_TIMEOUT_SECONDS:
                raise ClusterError(
                    f"no suitable worker was available for {NO_WORKER_TIMEOUT_SECONDS:.0f} s: start one with "
                    "`dask worker ADDRESS --preload autograder.grade.cluster`"
                )
        return self._threads

    def _poll(self) -> None:
        """Count the threads of the suitable workers, and report once why each other worker is rejected."""
        try:
            workers = self._client.scheduler_info()["workers"]
        except (OSError, RuntimeError, TimeoutError) as error:
            raise ClusterError(f"the scheduler does not respond: {error}") from None
        self._threads = 0
        for address, worker in workers.items():
            reason = difference(self._resource, worker["resources"])
            if not reason:
                self._threads += worker["nthreads"]
            elif address not in self._rejected_addresses:
                self._rejected_addresses.add(address)
                self._report(f"The worker {address} is rejected: {reason}.")

    def _pending_submissions(self, jobs: Sequence[Job]) -> Iterator[_Pending]:
        """Yield the submissions to send. Store a result for each one that intake rejects.

        They are read in this process, because a sandbox for each would take longer than 64 workers need to grade it.
        Intake limits sizes, counts and time, but not the memory of a process in which Dask's client has a thread.
        """
        for job in jobs:
            try:
                files = read_files(job.path, job.assignment)
            except StudentError as error:
                self._on_result(write_result(job, unclear_result(job, error.diagnosis), {}))
                continue
            yield _Pending(job, digest(files), Task(job, tuple(files)).pack())

    def _send(self, pending: _Pending) -> None:
        future = self._client.submit(
            self._grade, pending.task, key=f"grade-{uuid.uuid4()}", resources={self._resource: 1}, pure=False
        )
        self._in_progress[future] = pending
        future.add_done_callback(self._finished_futures.put)

    def _receive(self) -> None:
        """Wait up to `TICK` seconds for a result, and process it."""
        try:
            future = self._finished_futures.get(timeout=TICK)
        except queue.Empty:
            self._suitable_threads()  # raises an error if the scheduler or the last worker is lost
            return
        pending = self._in_progress.pop(future)
        if future.status == "cancelled":
            raise ClusterError("the connection to the scheduler was lost")
        if future.status == "error":
            reason = f"{MAX_WORKER_DEATHS} workers died while they graded this submission."
            self._give_up(pending.job, reason, f"{future.exception()!r}\n")
            return
        try:
            self._on_result(accept(future.result(), pending.job, pending.sha256))
        except ReplyError as error:
            if pending.tries < TRIES:
                self._send(replace(pending, tries=pending.tries + 1))
                return
            reason = f"Workers failed on this submission {TRIES} times."
            self._give_up(pending.job, reason, f"{error}\n")

    def _give_up(self, job: Job, reason: str, log: str) -> None:
        self._on_result(write_result(job, *not_graded_result(job, reason, log)))
