"""The service's shared state, and the rules for handing in."""

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

MAX_HUB_REQUESTS = 8  # requests to the hub at the same time


class Refused(HTTPError):
    """A refused request: the HTTP status, and the sentence for the page or the JSON of the response."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(status, sentence)
        self.sentence = sentence


@dataclass(frozen=True)
class Service:
    """The state that the handlers and the exchange share. `now` returns the current time with its zone."""

    settings: Settings
    store: Store
    grader: Grader
    prefix: str
    now: Callable[[], datetime] = lambda: datetime.now(timezone.utc)
    # Requests of a whole class wait here, because they would time out in the queue of the hub's client.
    hub_requests: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(MAX_HUB_REQUESTS))

    def require_try_left(self, student: str, assignment: str, at: datetime) -> None:
        """Raise Refused, with the reason, if a student cannot hand in a configured assignment at this time."""
        rules = self.settings.assignments[assignment]
        due = rules.due_of(student)
        if due is not None and not rules.is_open(student, at):
            due_text = due.astimezone(self.settings.zone).strftime(TIME)
            raise Refused(403, f"{assignment} was due at {due_text}. Ask your instructor.")
        if self.tries_left(student, assignment, at) == 0:
            raise Refused(429, f"You have handed in {rules.tries_a_day} times today. Hand in again tomorrow.")

    def tries_left(self, student: str, assignment: str, at: datetime) -> int:
        """Return how often a student can still hand in an assignment on the day of this time."""
        hand_ins = self.store.of_student(student)
        times = [hand_in.at for hand_in in hand_ins if hand_in.assignment == assignment and hand_in.costs_a_try]
        return self.settings.tries_left(assignment, times, at)
