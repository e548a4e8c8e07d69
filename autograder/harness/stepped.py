"""A harness in lockstep: the programs' ROS time goes on only when the grader says so."""

from __future__ import annotations

import math
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.harness.base import Harness
from autograder.harness.matching import connected
from autograder.harness.programs import Program, error_of
from autograder.lockstep import Description, Stepper, UnsteppableError
from autograder.lockstep.lockstep_host import channels
from autograder.lockstep.protocol import START
from autograder.sandbox import Process

DELIVERY_SECONDS = 15.0  # real time, over a whole run, for messages that were announced and have not come yet
SETTLE_SECONDS = 5.0  # real time for the names of the programs' nodes to be seen
FINEST_TICK_NS = 10_000_000
SLACK_NS = 1_000_000  # what wants to wake so shortly before the end of a step wakes at its end
ROUNDS = 1000  # in one step; programs that still answer each other then will go on for ever


class SteppedProgram:
    """One program of a harness in lockstep, and the mail that it has not been told of."""

    def __init__(self, program: Program, stepper: Stepper) -> None:
        self.program = program
        self.stepper = stepper
        self.description = Description()
        self.reads: frozenset[str] = frozenset()
        self.mail: Counter[str] = Counter()
        self.wake: int | None = None
        self.idle: int | None = None

    def describe(self) -> Description:
        """Ask what the program's nodes look like now."""
        self.description = self.stepper.describe()
        self.reads = self.description.reads()
        return self.description


class _Spared(Exception):
    """A program that may fail has failed, and the harness no longer has it."""


class SteppedHarness(Harness):
    """Programs that are stepped through ROS time: faster than real time, and the same every time.

    They start at ROS time `START`. `tick_ns` hits every firing of their timers, between 10 ms and 100 ms. A step is
    lived in rounds, the programs always in the order in which they were named: first all take what was sent before,
    then their timers fire, then they take what they sent each other, until nobody has anything left to take.

    Attributes:
        notes: by executable, why steps are not all that moves a program, if so: thread, clock or sleep.
    """

    _stepped: Sequence[SteppedProgram] = ()

    def _start(self) -> None:
        self._now_ns = START
        self.notes: dict[str, str] = {}
        self._patience = DELIVERY_SECONDS
        for program, path in zip(self.programs, self._paths, strict=True):
            arguments = program.words(self._folder)
            stepper = Stepper(self._sandbox, path, python=sys.executable, arguments=arguments)
            self._stepped = [*self._stepped, SteppedProgram(program, stepper)]
        for stepped in self._stepped:
            with suppress(_Spared), self._attributing(stepped):
                stepped.stepper.wait_ready()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for stepped in self._stepped:
            stepped.stepper.__exit__(kind, error, trace)
        super().__exit__(kind, error, trace)

    @property
    def processes(self) -> tuple[Process, ...]:
        return tuple(stepped.stepper.process for stepped in self._stepped)

    @property
    def running(self) -> frozenset[str]:
        return frozenset(stepped.program.executable for stepped in self._stepped)

    @property
    def now_ns(self) -> int:
        return self._now_ns

    @property
    def seconds(self) -> float:
        return (self._now_ns - START) / 1e9

    def step(self, dt_ns: int) -> None:
        """Let the programs take what was published, then run the timers that are due.

        Raises:
            GraderError: messages were lost on the way, which loopback does not do by itself.
        """
        end = self._now_ns + dt_ns
        while True:
            self._advance(self._next_wake(end) - self._now_ns)
            if self._now_ns >= end:
                return

    def _next_wake(self, end: int) -> int:
        """Return the instant before `end` at which the first program wants to go on, or `end`."""
        earliest = self._now_ns + FINEST_TICK_NS
        wakes = [max(stepped.wake, earliest) for stepped in self._stepped if stepped.wake is not None]
        return min((wake for wake in wakes if wake < end - SLACK_NS), default=end)

    def _advance(self, dt_ns: int) -> None:
        self._now_ns += dt_ns
        if dt_ns and len(self._stepped) == 1:
            self._let_run(self._stepped[0], [self._now_ns - 1, self._now_ns])
        elif dt_ns:
            self._settle(self._now_ns - 1)
            for stepped in self._stepped:
                self._let_run(stepped, [self._now_ns])
        self._settle(self._now_ns)

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        self.step(0)
        end = self._now_ns + round(seconds * 1e9)
        while not condition():
            if self._now_ns >= end:
                return False
            self.step(min(self.tick_ns, end - self._now_ns))
        return True

    def quit(self) -> int | None:
        """Interrupt the programs as Ctrl-C does; return the first one's exit status, None if it did not stop."""
        statuses = [stepped.stepper.quit() for stepped in self._stepped]
        return statuses[0]

    # Rounds.

    def _settle(self, instant: int) -> None:
        """Go round, at one instant, until nobody has mail."""
        for _ in range(ROUNDS):
            self._post(self._grader_node.sent)
            if not any(stepped.mail for stepped in self._stepped):
                return
            for stepped in self._stepped:
                if stepped.mail:
                    self._turn(stepped, [instant])
        sentence = (
            f"Your nodes answered each other {ROUNDS} times without any time going by, and would go on for ever: a "
            "callback must not publish what makes it run again."
        )
        raise StudentError(Diagnosis(Kind.STUCK, sentence))

    def _let_run(self, stepped: SteppedProgram, instants: list[int]) -> None:
        """Let one program live through instants, if it has anything to do then."""
        self._post(self._grader_node.sent)
        if stepped.mail or stepped.idle is None or stepped.idle <= instants[-1]:
            self._turn(stepped, instants)

    def _turn(self, stepped: SteppedProgram, instants: list[int]) -> None:
        """Let one program live through instants, and deliver what it sends."""
        if stepped not in self._stepped:
            return
        self._post(self._grader_node.sent)
        mail, stepped.mail = stepped.mail, Counter()
        try:
            with self._attributing(stepped):
                reply = stepped.stepper.step(instants, mail)
        except _Spared:
            return
        stepped.wake, stepped.idle = reply.wake, reply.idle
        for reason in reply.notes:
            self.notes.setdefault(stepped.program.executable, reason)
        for channel in reply.late:
            # What others of the student's programs claim to have sent may be forged; what the grader sent is not.
            if mail[channel] and channel in self._grader_node.written.values():
                raise GraderError(f"messages that were sent to the student's node did not arrive: {channel}")
        self._post(reply.sent, but=stepped)
        self._expect(reply.sent)
        self._collect()
        if reply.changed:
            self._meet()

    def _post(self, sent: dict[str, int], but: SteppedProgram | None = None) -> None:
        """Put into every program's mail what was sent to it."""
        for channel, count in sent.items():
            for stepped in self._stepped:
                if stepped is not but and channel in stepped.reads:
                    stepped.mail[channel] += count
        if sent is self._grader_node.sent:
            self._grader_node.sent.clear()

    def _expect(self, sent: dict[str, int]) -> None:
        for channel, count in sent.items():
            for ear in self._grader_node.ears:
                if channel in ear.channels:
                    ear.expected += count

    def _collect(self) -> None:
        """Hear all that was said to the grader.

        A count that is never reached is forged, or the student's own QoS dropped a message. Only what arrived counts,
        and all waiting in vain has one bound.
        """
        while not self._grader_node.hear() and self._patience > 0.0:
            began = time.monotonic()
            self._spin(0.05)
            if not self._grader_node.hear():
                self._patience -= time.monotonic() - began
        for ear in self._grader_node.ears:
            ear.expected = ear.count

    # Meeting.

    def _meet(self) -> None:
        while True:
            with suppress(_Spared):
                return self._meet_all()

    def _meet_all(self) -> None:
        super()._meet()
        descriptions = [stepped.description for stepped in self._stepped]
        for stepped in self._stepped:
            others = [description for description in descriptions if description is not stepped.description]
            early = _sum(description.early for description in others)
            with self._attributing(stepped):
                stepped.stepper.meet(
                    _sum(description.kept for description in others),
                    {channel: count for channel, count in early.items() if not channels.is_topic(channel)},
                )
            stepped.idle = None  # there may be something for it to take
        for ear in self._grader_node.ears:
            if ear.new:
                ear.new = False
                source = [d.early if ear.kind == "service" else d.kept if ear.latched else {} for d in descriptions]
                ear.expected += sum(_sum(source)[channel] for channel in ear.channels)
        self._collect()

    def _topics(self) -> tuple[set[str], set[str]]:
        descriptions = self._describe()
        self.tick_ns = max(FINEST_TICK_NS, math.gcd(self.tick_ns, *(p for d in descriptions for p in d.timers)))
        subscribed = {channels.topic_of(name[0]) for d in descriptions for name, _ in d.readers if name}
        published = {channels.topic_of(name) for d in descriptions for name, _ in d.writers}
        subscribed, published = subscribed & set(self._offers), published & set(self._listens)
        self._await(lambda: all(map(self._readers, subscribed)) and all(map(self._writers, published)))
        names = {name for description in descriptions for name in description.nodes}
        self.wait_for(lambda: names <= set(self.nodes()), SETTLE_SECONDS)
        return subscribed, published

    def _connected(self) -> bool:
        return connected(self._describe(), self._grader_node)

    def _describe(self) -> list[Description]:
        found = []
        for stepped in self._stepped:
            with self._attributing(stepped):
                found.append(stepped.describe())
        return found

    def _reach(self, client: Any, seconds: float) -> bool:
        channel = channels.request(client.srv_name, client.srv_type)

        def there() -> bool:
            return any(channel in stepped.description.servers for stepped in self._stepped)

        if not there() and not self.until(there, seconds):
            return False
        self._await(client.service_is_ready)
        return True

    @contextmanager
    def _attributing(self, stepped: SteppedProgram) -> Iterator[None]:
        """Go on without a program that failed and may; of others say which of several it was."""
        try:
            yield
        except UnsteppableError as error:  # even of an optional program: no fault of the program's
            self.notes[stepped.program.executable] = error.reason
            raise
        except StudentError as error:
            if stepped.program.executable in self.optional:
                self._stepped = [other for other in self._stepped if other is not stepped]
                stepped.stepper.__exit__(None, None, None)
                raise _Spared from None
            raise error_of(stepped.program, error, len(self._stepped)) from None


def _sum(counts: Iterable[dict[str, int]]) -> Counter[str]:
    return sum(map(Counter, counts), Counter[str]())
