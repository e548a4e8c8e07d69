"""Grades waiting answers, one after the other or several at once, in the sandbox of `autograder grade`."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from autograder.grade import DEFAULT_SEED, grade_submission
from autograder.grade.job import Job
from autograder.lms.serve import visible
from autograder.lms.serve.hand_in import HandIn, Mark
from autograder.lms.serve.queue import ahead_of, next_turn
from autograder.lms.serve.settings import Settings, Shown
from autograder.lms.serve.store import Store
from autograder.report import feedback
from autograder.result.model import Result
from autograder.run.sandbox import Isolation

LOG = logging.getLogger(__name__)
ANSWER = "answer.zip"  # whatever it is: intake reads an archive by its bytes

Grade = Callable[[Job], Result]


@dataclass(frozen=True)
class Way:
    """How answers are graded: how many at once, the seed, the isolation level, and the grading function."""

    jobs: int = 1
    seed: int = DEFAULT_SEED
    isolation: Isolation = Isolation.BUBBLEWRAP
    grade: Grade = grade_submission


class Grader:
    """Takes answers out of the queue. All of it but the gradings themselves happens in the loop's thread."""

    def __init__(self, settings: Settings, store: Store, way: Way) -> None:
        self._settings, self._store, self._way = settings, store, way
        self._came = asyncio.Condition()
        self._busy: dict[str, int] = {}  # students whose answer is being graded, with its number
        self._set_aside: set[int] = set()  # on which the machine failed; they wait for the next start

    async def notify(self) -> None:
        """Say that an answer came."""
        async with self._came:
            self._came.notify_all()

    def is_graded_now(self, number: int) -> bool:
        """Return whether a grading of this number is running."""
        return number in self._busy.values()

    def ahead_of(self, number: int) -> int:
        """Return how many answers are graded before the one of this number, which waits."""
        waiting = [each for each in self._store.waiting() if not self.is_graded_now(each.number)]
        return len(self._busy) + ahead_of(number, waiting, self._store.turns(), self._busy)

    async def run(self) -> None:
        """Grade for as long as the process lives."""
        with ThreadPoolExecutor(self._way.jobs) as pool:
            await asyncio.gather(*(self._work(pool) for _ in range(self._way.jobs)))

    async def _work(self, pool: ThreadPoolExecutor) -> None:
        while True:
            handed_in = await self._take()
            try:
                answer = self._store.begin(handed_in.number)
                out = self._store.folder(handed_in.number)
                mark = await asyncio.get_running_loop().run_in_executor(pool, self._grade, handed_in, answer, out)
                self._store.finish(handed_in.number, mark)
            except Exception:  # of the machine: a submission's own failures are already in its result
                LOG.exception("Number %d was not graded. It waits for the next start.", handed_in.number)
                self._set_aside.add(handed_in.number)
            finally:
                del self._busy[handed_in.student]
                await self.notify()  # the student may have another one

    async def _take(self) -> HandIn:
        """Wait for an answer to grade, and return it. From then on, its student is busy."""
        async with self._came:
            while True:
                waiting = (each for each in self._store.waiting() if each.number not in self._set_aside)
                turn = next_turn(waiting, self._store.turns(), self._busy)
                if turn is not None and (hand_in := self._store.with_number(turn.number)) is not None:
                    self._busy[hand_in.student] = hand_in.number
                    return hand_in
                await self._came.wait()

    def _grade(self, handed_in: HandIn, answer: bytes, out: Path) -> Mark:
        """Grade an answer into its folder, with its page. A folder left by a killed process is rewritten."""
        with TemporaryDirectory(prefix="answer-") as scratch:
            path = Path(scratch) / ANSWER
            path.write_bytes(answer)
            job = Job(path, handed_in.assignment, handed_in.student, self._way.seed, out, self._way.isolation)
            result = self._way.grade(job)
            settings = self._settings.assignments.get(handed_in.assignment)
            if settings is not None and settings.shown is Shown.VISIBLE:
                visible.write(visible.run_visible(path, handed_in.assignment, self._way.isolation), out)
        feedback.write(result, out)
        return Mark(result.status, result.score, result.max_score)
