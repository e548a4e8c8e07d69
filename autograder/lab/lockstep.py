"""A lab in lockstep: the program's ROS time goes on only when the grader says so."""

from __future__ import annotations

import math
import sys
import time
from types import TracebackType
from typing import Any

from autograder.exceptions import GraderError
from autograder.lab.meeting import Lab
from autograder.lockstep import Stepper
from autograder.lockstep.protocol import START
from autograder.sandbox import Process

DELIVERY_SECONDS = 15.0  # real time, over a whole run, for messages that were announced and have not come yet
SETTLE_SECONDS = 5.0  # real time for the names of the program's nodes to be seen
FINEST_TICK_NS = 10_000_000


class LockstepLab(Lab):
    """A program that is stepped through ROS time: faster than real time, and the same every time.

    It starts at ROS time `START`. `tick_ns` hits every firing of its timers, between 10 ms and 100 ms.
    """

    def _start(self) -> None:
        self._now_ns = START
        self._sent: dict[str, int] = {}
        self._baseline: dict[str, int] = {}
        self._patience = DELIVERY_SECONDS
        self._stepper = Stepper(self._sandbox, self._program, python=sys.executable, arguments=self._arguments)
        self._stepper.wait_ready()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stepper.__exit__(kind, error, trace)
        super().__exit__(kind, error, trace)

    @property
    def process(self) -> Process:
        return self._stepper.process

    @property
    def now_ns(self) -> int:
        return self._now_ns

    @property
    def seconds(self) -> float:
        return (self._now_ns - START) / 1e9

    def publish(self, topic: str, message: Any) -> None:
        super().publish(topic, message)
        if self.takes(topic):
            self._sent[topic] = self._sent.get(topic, 0) + 1

    def step(self, dt_ns: int) -> None:
        """Let the program take what was published, then run the timers that are due.

        Raises:
            GraderError: messages were lost on the way, which loopback does not do by itself.
        """
        self._now_ns += dt_ns
        reply = self._stepper.step(self._now_ns, self._sent)
        if reply.late:
            raise GraderError("messages that were sent to the student's node did not arrive")
        # A count that is never reached is forged, or the student's own QoS dropped a message. Only what arrived counts,
        # and all waiting in vain has one bound.
        while not self._arrived(reply.published) and self._patience > 0.0:
            began = time.monotonic()
            self._spin(0.05)
            if not self._arrived(reply.published):
                self._patience -= time.monotonic() - began
        for topic, messages in self._received.items():
            self._baseline[topic] = reply.published.get(topic, 0) - len(messages)

    def quit(self) -> int | None:
        """Interrupt the program as Ctrl-C does; return its exit status, None if it did not stop."""
        return self._stepper.quit()

    def _topics(self) -> set[str]:
        description, before = self._stepper.describe()
        self.tick_ns = max(FINEST_TICK_NS, math.gcd(self.tick_ns, *description.timers))
        topics = {topic for topic in description.unmatched if topic in self._offers or topic in self._listens}
        self._baseline = {topic: before.published.get(topic, 0) for topic in self._received}
        self._await(lambda: all(self._peers(topic) for topic in topics))
        self.wait_for(lambda: set(description.nodes) <= set(self.nodes()), SETTLE_SECONDS)
        return topics

    def _connected(self, topics: set[str]) -> bool:
        description, _ = self._stepper.describe()
        matched = all(
            publisher.get_subscription_count() >= description.subscriptions.get(topic, 0)
            for topic, publisher in self._publishers.items()
        )
        return matched and not topics & set(description.unmatched)

    def _arrived(self, published: dict[str, int]) -> bool:
        return all(
            len(messages) >= published.get(topic, 0) - self._baseline.get(topic, 0)
            for topic, messages in self._received.items()
        )
