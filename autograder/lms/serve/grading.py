"""Grades queued answers, one or several at a time, in the sandbox of `autograder grade`."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from autograder.grade import grade_submission
from autograder.grade.job import Job
from autograder.lms.serve import visible
from autograder.lms.serve.hand_in import HandIn, Mark
from autograder.lms.serve.queue import ahead_of, next_turn
from autograder.lms.serve.settings import Settings, ShownParts
from autograder.lms.serve.store import Store
from autograder.report import feedback
from autograder.result.model import Result
from autograder.run.sandbox import Isolation

LOG = logging.getLogger(__name__)
ANSWER = "answer.zip"  # the name for any archive; intake detects the type from the content

Grade = Callable[[Job], Result]


@dataclass(frozen=True)
class GradingOptions:
    """The number of simultaneous gradings, the seed, the isolation level, and the function that grades an answer."""

    jobs: int
    seed: int
    isolation: Isolation
    grade: Grade = grade_submission


class Grader:
    """Grades the answers in the queue. Everything except the gradings themselves runs in the event loop's thread."""

    def __init__(self, settings: Settings, store: Store, options: GradingOptions) -> None:
        self._settings, self._store, self._options = settings, store, options
        self._queue_changed = asyncio.Condition()
        self._number_by_student: dict[str, int] = {}  # for each student whose answer is being graded, its number
        self._failed_numbers: set[int] = set()  # numbers of answers whose grading failed; they wait for the next start

    async def notify(self) -> None:
        """Wake idle workers, because the queue has changed."""
        async with self._queue_changed:
            self._queue_changed.notify_all()

    def is_being_graded(self, number: int) -> bool:
        """Return whether the grading of the answer with this number is running."""
        return number in self._number_by_student.values()

    def ahead_of(self, number: int) -> int:
        """Return how many answers are graded before the queued one with this number."""
        waiting = [hand_in for hand_in in self._store.waiting() if not self.is_being_graded(hand_in.number)]
        return len(self._number_by_student) + ahead_of(number, waiting, self._store.turns(), self._number_by_student)

    async def run(self) -> None:
        """Grade until the process ends."""
        with ThreadPoolExecutor(self._options.jobs) as pool:
            await asyncio.gather(*(self._work(pool) for _ in range(self._options.jobs)))

    async def _work(self, pool: ThreadPoolExecutor) -> None:
        while True:
            hand_in = await self._next_hand_in()
            try:
                answer = self._store.begin(hand_in.number)
                out = self._store.folder(hand_in.number)
                mark = await asyncio.get_running_loop().run_in_executor(pool, self._grade, hand_in, answer, out)
                self._store.finish(hand_in.number, mark)
            except Exception:  # the machine failed; a submission's own failure is in its result
                LOG.exception("Number %d was not graded. It waits for the next start.", hand_in.number)
                self._failed_numbers.add(hand_in.number)
            finally:
                del self._number_by_student[hand_in.student]
                await self.notify()  # the student may have another queued answer

    async def _next_hand_in(self) -> HandIn:
        """Wait for an answer to grade, mark its student as busy, and return it."""
        async with self._queue_changed:
            while True:
                waiting = (hand_in for hand_in in self._store.waiting() if hand_in.number not in self._failed_numbers)
                if hand_in := next_turn(waiting, self._store.turns(), self._number_by_student):
                    self._number_by_student[hand_in.student] = hand_in.number
                    return hand_in
                await self._queue_changed.wait()

    def _grade(self, hand_in: HandIn, answer: bytes, out: Path) -> Mark:
        """Grade an answer, and write its result and page to `out`, replacing any that a killed process left."""
        with TemporaryDirectory(prefix="answer-") as scratch:
            path = Path(scratch) / ANSWER
            path.write_bytes(answer)
            options = self._options
            job = Job(path, hand_in.assignment, hand_in.student, options.seed, out, options.isolation)
            result = options.grade(job)
            settings = self._settings.assignments.get(hand_in.assignment)
            if settings is not None and settings.shown is ShownParts.VISIBLE:
                visible.write(visible.run_visible(path, hand_in.assignment, options.isolation), out)
        feedback.write(result, out)
        return Mark(result.status, result.score, result.max_score)
