"""Limits the messages that a harness takes from a student's programs, because they stay in the grader's memory."""

from __future__ import annotations

from collections import Counter

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.sandbox.limits import MIB, RECEIVED_MESSAGES, MessageLimits


class Inflow:
    """Counts the messages of all topics of one harness, and their bytes on the wire."""

    def __init__(self, limits: MessageLimits = RECEIVED_MESSAGES) -> None:
        self._limits = limits
        self._messages: Counter[str] = Counter()  # by topic
        self._bytes: Counter[str] = Counter()

    def add(self, topic: str, size: int) -> None:
        """Count a message of `size` bytes, before it is parsed.

        Raises:
            StudentError: there are too many messages or bytes. The error names the topic with the largest share.
        """
        self._messages[topic] += 1
        self._bytes[topic] += size
        if self._bytes.total() > self._limits.size:
            raise self._error(max(self._bytes, key=self._bytes.__getitem__))
        if self._messages.total() > self._limits.messages:
            raise self._error(max(self._messages, key=self._messages.__getitem__))

    def _error(self, topic: str) -> StudentError:
        sentence = (
            f"Your programs sent {self._messages[topic]:,} messages ({self._bytes[topic] / MIB:.1f} MiB in all) on "
            f"{topic}, but the grader accepts at most {self._limits.messages:,} messages and "
            f"{self._limits.size / MIB:.0f} MiB from all topics in one run: publish small messages at the required "
            "rate."
        )
        return StudentError(Diagnosis(Kind.FLOODED_OUTPUT, sentence))
