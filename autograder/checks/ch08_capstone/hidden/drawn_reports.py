"""Messages that status_monitor may receive from the other nodes, and the reports that the contract requires."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Collection
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from geometry_msgs.msg import Twist
from hypothesis import strategies as st

from autograder.checking import LOCKSTEP, REAL, SCAN_SECONDS, ReceivedMessage, expect
from autograder.checks.ch08_capstone.hidden.drawn_drives import CLEAR
from autograder.checks.ch08_capstone.support.contract import (
    DEGRADED,
    FAILED,
    LEVELS,
    MONITOR,
    OK,
    PARAMETERS,
    WATCHED_TOPICS,
)
from autograder.checks.ch08_capstone.support.system import System

SILENCE_TIMEOUT = PARAMETERS[MONITOR]["silence_timeout"].default
MARGIN = {LOCKSTEP: 0.06, REAL: 0.25}  # s around silence_timeout, in which a topic may count as silent or not
ALL_TOPICS = frozenset(WATCHED_TOPICS)
SOME_TOPICS = [frozenset(topics) for count in range(len(ALL_TOPICS)) for topics in combinations(WATCHED_TOPICS, count)]


@dataclass(frozen=True)
class Span:
    """A span of time in which messages are published ten times a second.

    Attributes:
        topics: the topics on which they are published.
        messages: how many are published on each topic, one every 0.1 s.
        blind: the sector whose distance in the clearance is nan, or an empty string.
        age: the age of the stamps of scans and clearances, in seconds; below 0 if they are ahead of the clock.
    """

    topics: frozenset[str]
    messages: int
    blind: str = ""
    age: float = 0.0

    def __repr__(self) -> str:
        topics = f"messages on {', '.join(sorted(self.topics))}" if self.topics else "no messages"
        blind = f" ({self.blind} is nan)" if self.blind and "clearance" in self.topics else ""
        age = f", stamped {self.age:.1f} s earlier" if self.age > 0.0 else ""
        age = f", stamped {-self.age:.1f} s ahead of the clock" if self.age < 0.0 else age
        return f"{topics}{blind} for {self.messages * SCAN_SECONDS:.1f} s{age * bool(self.topics)}"


History = tuple[Span, ...]


class ReportRule:
    """The contract's rule for the monitor's reports, which depend on the messages that the monitor has received."""

    def __init__(self, silence_timeout: float, margin: float) -> None:
        self._timeout, self._margin = silence_timeout, margin
        self._arrivals = dict.fromkeys(WATCHED_TOPICS, -math.inf)
        self._validity: list[tuple[float, bool]] = []

    def hear(self, topic: str, now: float, *, valid: bool) -> None:
        """Remember a message, and for a clearance whether it is valid."""
        self._arrivals[topic] = now
        if topic == "clearance":
            self._validity.append((now, valid))

    def is_correct(self, report: ReceivedMessage) -> bool:
        """Return whether a report lists the silent topics, and has the level that follows from them."""
        silent, excesses = (
            silent_topics(report),
            {topic: report.seconds - arrival - self._timeout for topic, arrival in self._arrivals.items()},
        )
        if any((excess > 0) != (topic in silent) for topic, excess in excesses.items() if abs(excess) > self._margin):
            return False
        if silent:
            return bool(report.message.level == FAILED and silent <= ALL_TOPICS)
        # A clearance that arrives at the same time as the report may count already, or not yet.
        arrivals = [arrival for arrival, _ in self._validity]
        first_index = bisect_left(arrivals, report.seconds - self._margin)
        possible_levels = {OK if valid else DEGRADED for _, valid in self._validity[max(0, first_index - 1) :]}
        return report.message.level in possible_levels

    def expected(self, now: float) -> str:
        """Describe the report that the contract requires at this time."""
        silent = [topic for topic, arrival in self._arrivals.items() if now - arrival > self._timeout]
        level = FAILED if silent else OK if self._validity[-1][1] else DEGRADED
        return report_text(level, silent)


def expect_reports(
    system: System, history: History, *, fraction: float = 0.0, silence_timeout: float = SILENCE_TIMEOUT
) -> None:
    """Publish messages on all topics, then a history; fail the check unless each report during it is correct."""
    rule = ReportRule(silence_timeout, MARGIN[system.harness.time])
    for number, span in enumerate((Span(ALL_TOPICS, 3), *history)):
        for _ in range(span.messages):
            start = system.seconds
            send_all(system, span.topics, span.blind, span.age)
            for topic in span.topics:
                rule.hear(topic, system.seconds, valid=not span.blind)
            for report in system.messages(start).reports if number else ():
                history_text = "; then ".join(map(repr, history[:number]))
                situation = f"First messages on all topics; then {history_text}. In this situation"
                expect(
                    rule.is_correct(report),
                    f"{situation}, health had {describe(report.message)}, instead of {rule.expected(report.seconds)}.",
                    fraction=fraction,
                )


def send_all(system: System, topics: Collection[str], blind: str = "", age: float = 0.0) -> None:
    """Send the monitor a message on each of these topics, and let 0.1 s pass."""
    distances = {"front": math.inf, "left": math.inf, "right": math.inf} | ({blind: math.nan} if blind else {})
    clearance = system.types.clearance(valid=not blind, **distances)
    messages: dict[str, Any] = {"scan": CLEAR.scan(), "clearance": clearance, "cmd_vel": Twist()}
    for topic in topics:
        system.send(f"/{topic}", messages[topic], age)
    system.harness.run(SCAN_SECONDS)


def silent_topics(report: ReceivedMessage) -> set[str]:
    """Return the topics that a report lists as silent."""
    return {str(topic).lstrip("/") for topic in report.message.silent}


def describe(report: Any) -> str:
    """Describe a report of the monitor."""
    return report_text(report.level, [str(topic)[:40] for topic in list(report.silent)[:5]])


def report_text(level: int, silent: Collection[str]) -> str:
    """Return a level and silent topics as text."""
    return f"level {LEVELS[level] if 0 <= level < len(LEVELS) else level} (silent: {', '.join(silent) or 'none'})"


_BLIND = st.sampled_from(("", "front", "left", "right"))
_AGES = st.sampled_from((0.0, 0.3, 1.5, 30.0, -0.5, -5.0))


# The lidar dies after scans with stamps ahead of the clock. Only their arrival shows how long scan has been silent.
SCANS_STAMPED_AHEAD = (
    Span(ALL_TOPICS, 5, age=-5.0),
    Span(ALL_TOPICS - {"scan"}, round(SILENCE_TIMEOUT / SCAN_SECONDS) + 10),
)
# One topic is silent, and then another one, so that no topic may count as heard because another one is.
ONE_SILENT_TOPIC = Span(ALL_TOPICS - {"clearance"}, 20), Span(ALL_TOPICS, 3), Span(ALL_TOPICS - {"cmd_vel"}, 20)


@st.composite
def seeing(draw: st.DrawFn) -> History:
    """Draw a history of messages on all topics, with pauses that are shorter or slightly longer than the time-out."""
    spans: list[Span] = []
    for blind in draw(st.lists(_BLIND, min_size=2, max_size=4)):
        spans.append(Span(ALL_TOPICS, draw(st.integers(2, 9)), blind, draw(_AGES)))
        pause = draw(st.sampled_from((0, 0, 8, 13)))
        spans += [Span(frozenset(), pause)] * bool(pause)
    return tuple(spans)


@st.composite
def silences(draw: st.DrawFn, timeout: float = SILENCE_TIMEOUT) -> History:
    """Draw a history in which some topics are silent for about the time-out, or for longer."""
    spans: list[Span] = []
    for topics in draw(st.lists(st.sampled_from(SOME_TOPICS), min_size=2, max_size=3)):
        spans.append(
            Span(topics, round(timeout / SCAN_SECONDS) + draw(st.sampled_from((-2, 2, 4, 6))), age=draw(_AGES))
        )
        if draw(st.booleans()):
            spans.append(Span(ALL_TOPICS, draw(st.integers(1, 5)), draw(_BLIND), draw(_AGES)))
    return tuple(spans)
