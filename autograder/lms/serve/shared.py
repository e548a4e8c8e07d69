"""The service's shared state, and who can hand in when."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime, timezone

from tornado.web import HTTPError

from autograder.lms.serve.grading import Grader
from autograder.lms.serve.pages import TIME
from autograder.lms.serve.settings import Settings
from autograder.lms.serve.store import Store

MOST_QUESTIONS = 8  # to the hub at once


class Refused(HTTPError):
    """An answer to a wrong request: a status, and the sentence that its page or its JSON says."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(status, sentence)
        self.sentence = sentence


@dataclass(frozen=True)
class Service:
    """The shared state of what takes answers in. `now` returns the current time, with its zone."""

    settings: Settings
    store: Store
    grader: Grader
    prefix: str
    now: Callable[[], datetime] = lambda: datetime.now(timezone.utc)
    # A whole class at once waits here: in the queue of the client that asks the hub, it would time out.
    asking: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MOST_QUESTIONS))

    def require_a_try(self, student: str, assignment: str, at: datetime) -> None:
        """Raise Refused, with the reason, if a student cannot hand in an assignment of the settings at this time."""
        each = self.settings.assignments[assignment]
        due = each.due_of(student)
        if due is not None and not each.is_open(student, at):
            when = due.astimezone(self.settings.zone).strftime(TIME)
            raise Refused(403, f"{assignment} was due at {when}. Ask your instructor.")
        if self.tries_left(student, assignment, at) == 0:
            raise Refused(429, f"You have handed in {each.tries_a_day} times today. Hand in again tomorrow.")

    def tries_left(self, student: str, assignment: str, at: datetime) -> int:
        """Return how often a student can still hand in an assignment on that day."""
        own = self.store.of_student(student)
        times = [one.at for one in own if one.assignment == assignment and one.costs_a_try]
        return self.settings.tries_left(assignment, times, at)
