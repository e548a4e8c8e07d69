"""A harness in lockstep: ROS time advances only when the grader steps it."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import DoubtfulError, StudentError
from autograder.harness.base import Harness
from autograder.harness.matching import connected
from autograder.harness.steps import next_instant, tick_of
from autograder.harness.turns import Place, SteppedProgram, Turn, batches, flow, turns_of
from autograder.run.lockstep import Description, Stepper, UnsteppableError
from autograder.run.lockstep.lockstep_host import channels
from autograder.run.lockstep.protocol import START_NS
from autograder.run.sandbox import Process

DELIVERY_SECONDS = 15.0  # maximum real time that a whole run waits for announced messages
SETTLE_SECONDS = 5.0  # maximum real time until the names of the programs' nodes are visible
MAX_ROUNDS = 1000  # at one instant; programs that answer each other more often would never stop


class _OptionalProgramLost(Exception):
    """An optional program failed, and the harness has dropped it."""


class SteppedHarness(Harness):
    """Programs that are stepped through ROS time. This is faster than real time, and all runs are the same.

    They start at ROS time `START_NS`. `tick_ns` is between 10 ms and 100 ms, and is chosen so that their timers fire at
    the end of a step. In a step, the programs first take the messages that were sent before it, then their timers fire,
    and finally they take the messages that they sent to each other. `autograder.harness.turns` defines the order.

    Attributes:
        notes: for each executable that may also run between steps, the reason: one of the protocol's `REASONS`.
        activations: how often each executable was run, which determines the cost of a run in lockstep.
    """

    _stepped: Sequence[SteppedProgram] = ()
    _flow: Sequence[SteppedProgram] | None = None

    def _start(self) -> None:
        self._now_ns = START_NS
        self.notes: dict[str, str] = {}
        self.activations: Counter[str] = Counter()
        self._delivery_seconds = DELIVERY_SECONDS
        for number, (program, path) in enumerate(zip(self.programs, self._paths, strict=True)):
            stepper = self.enter_context(Stepper(self._sandbox, path, program.arguments, self._clock_rate))
            self._stepped = [*self._stepped, SteppedProgram(number, program, stepper)]
        for stepped in self._stepped:
            with suppress(_OptionalProgramLost), self._attribute_errors_to(stepped):
                stepped.stepper.wait_ready()

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
        return (self._now_ns - START_NS) / 1e9

    def step(self, dt_ns: int) -> None:
        """Let the programs take what was published, then run the timers that are due.

        Raises a DoubtfulError if a message is lost, because the loopback interface does not lose any by itself.
        """
        end = self._now_ns + dt_ns
        while True:
            self._advance(next_instant(self._now_ns, end, (stepped.wake for stepped in self._stepped)) - self._now_ns)
            if self._now_ns >= end:
                return

    def _advance(self, dt_ns: int) -> None:
        self._now_ns += dt_ns
        self._deliver_from_grader()
        instants = (self._now_ns - 1, self._now_ns) if dt_ns else ()
        alone = len(self._stepped) == 1
        # The grader may react to the response to a request, and its reaction belongs to the same phase.
        has_request = any(not channels.is_topic(name) for s in self._stepped for _, sent in s.inbox for name in sent)
        if self._flow is not None and (alone or not has_request):
            for stepped in self._flow if instants else ():
                for batch in batches(turns_of(stepped, instants, alone=alone)):
                    self._run(stepped, batch)
        else:
            for instant in instants:
                for stepped in self._stepped:
                    self._give_turn(stepped, instant, is_due=instant == self._now_ns and stepped.is_due(instant))
                self._settle(instant)
        self._settle(self._now_ns)

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        self.step(0)
        end = self._now_ns + round(seconds * 1e9)
        while not condition():
            if self._now_ns >= end:
                return False
            self.step(min(self.tick_ns, end - self._now_ns))
        return True

    # Turns.

    def _settle(self, instant: int) -> None:
        """Run rounds at one instant until no messages are left."""
        for _ in range(MAX_ROUNDS):
            self._deliver_from_grader()
            if not any(stepped.inbox for stepped in self._stepped):
                return
            for stepped in self._stepped:
                self._give_turn(stepped, instant)
        sentence = (
            f"Your nodes answered each other {MAX_ROUNDS} times at the same ROS time, and would continue for ever: a "
            "callback must not publish a message that makes it run again."
        )
        raise StudentError(Diagnosis(Kind.STUCK, sentence))

    def _give_turn(self, stepped: SteppedProgram, instant: int, *, is_due: bool = False) -> None:
        """Run a program if messages were sent to it, or if something in it is due."""
        self._deliver_from_grader()
        if stepped.inbox or is_due:
            self._run(stepped, [Turn(Place(), instant, stepped.take())])

    def _run(self, stepped: SteppedProgram, turns: list[Turn]) -> None:
        """Run a program for its turns, and deliver what it sends."""
        while turns and stepped in self._stepped:
            try:
                with self._attribute_errors_to(stepped):
                    reply = stepped.stepper.step([(turn.instant, turn.messages) for turn in turns])
            except _OptionalProgramLost:
                return
            self.activations[stepped.program.executable] += 1
            stepped.wake, stepped.due = reply.wake, reply.due
            for reason in reply.notes:
                self.notes.setdefault(stepped.program.executable, reason)
            finished_turns = turns[: len(reply.sent)]
            self._require_arrival(reply.lost, {channel for turn in finished_turns for channel in turn.messages})
            for turn, sent in zip(finished_turns, reply.sent, strict=True):
                self._deliver(turn.place, sent, sender=stepped)
                self._expect(sent)
            self._collect()
            turns = turns[len(finished_turns) :]
            if reply.changed:
                self._match()

    def _require_arrival(self, lost_channels: tuple[str, ...], announced_channels: set[str]) -> None:
        """Raise a DoubtfulError if a message of the grader that was announced to a program is lost."""
        for channel in lost_channels:
            # Only the grader's counts are reliable. The student's programs may forge the counts of what they sent.
            if channel in announced_channels and channel in self._grader_node.publisher_channels.values():
                sentence = (
                    f"A message that was sent to your node on {channel.split()[0]} did not arrive: do not replace "
                    "functions of rclpy, and take each message that arrives."
                )
                raise DoubtfulError(Diagnosis(Kind.STUCK, sentence))

    def _deliver_from_grader(self) -> None:
        """Deliver the messages that the grader has sent."""
        if self._grader_node.sent:
            self._deliver(Place(), self._grader_node.sent)
            self._grader_node.sent.clear()

    def _deliver(self, place: Place, sent: dict[str, int], sender: SteppedProgram | None = None) -> None:
        """Add the messages of a turn to the inbox of each program that reads their channels, except the sender's."""
        for stepped in self._stepped:
            counts = {name: count for name, count in sent.items() if name in stepped.description.reads}
            if stepped is not sender and counts:
                stepped.inbox.append((place, Counter(counts)))

    def _expect(self, sent: dict[str, int]) -> None:
        for channel, count in sent.items():
            for reader in self._grader_node.readers:
                if channel in reader.channels:
                    reader.expected += count

    def _collect(self) -> None:
        """Take all messages that were sent to the grader.

        If an announced message never arrives, the count was forged, or the student's QoS dropped the message. Only
        messages that arrived count. All waits for missing messages share one limit.
        """
        while not self._grader_node.take_expected() and self._delivery_seconds > 0.0:
            start = time.monotonic()
            self._grader_node.spin(0.05)
            if not self._grader_node.take_expected():
                self._delivery_seconds -= time.monotonic() - start
        for reader in self._grader_node.readers:
            reader.expected = reader.count

    # Matching.

    def _match(self) -> None:
        while True:
            with suppress(_OptionalProgramLost):
                return self._match_all()

    def _match_all(self) -> None:
        super()._match()
        descriptions = [stepped.description for stepped in self._stepped]
        for stepped in self._stepped:
            other_descriptions = [description for description in descriptions if description is not stepped.description]
            early = _sum(description.early for description in other_descriptions)
            with self._attribute_errors_to(stepped):
                stepped.stepper.match(
                    _sum(description.kept for description in other_descriptions),
                    {channel: count for channel, count in early.items() if not channels.is_topic(channel)},
                )
            stepped.due = 0  # messages for a new subscription may have arrived
        for reader in self._grader_node.readers:
            if reader.is_new:
                reader.is_new = False
                if reader.transient_local:
                    kept = _sum(description.kept for description in descriptions)
                    reader.expected += sum(kept[channel] for channel in reader.channels)
        self._collect()

    def _topics(self) -> tuple[set[str], set[str]]:
        descriptions = self._describe()
        self.tick_ns = tick_of(self.tick_ns, (period for description in descriptions for period in description.timers))
        subscribed = {channels.topic_of(name[0]) for d in descriptions for name, _ in d.readers if name}
        published = {channels.topic_of(name) for d in descriptions for name, _ in d.writers}
        subscribed, published = subscribed & set(self._publishes), published & set(self._subscribes)
        self._await(
            lambda: (
                all(map(self._grader_node.subscriptions_of, subscribed))
                and all(map(self._grader_node.publishers_of, published))
            )
        )
        names = {name for description in descriptions for name in description.nodes}
        self.wait_for(lambda: names <= set(self.nodes()), SETTLE_SECONDS)
        return subscribed, published

    def _connected(self) -> bool:
        return connected(self._describe(), self._grader_node)

    def _describe(self) -> list[Description]:
        descriptions = []
        for stepped in self._stepped:
            with self._attribute_errors_to(stepped):
                stepped.description = stepped.stepper.describe()
                descriptions.append(stepped.description)
        self._flow = flow(self._stepped)
        return descriptions

    def _wait_for_server(self, client: Any, seconds: float) -> bool:
        channel = channels.request(client.srv_name, client.srv_type)

        def is_served() -> bool:
            return any(channel in stepped.description.servers for stepped in self._stepped)

        if not is_served() and not self.until(is_served, seconds):
            return False
        self._await(client.service_is_ready)
        return True

    @contextmanager
    def _attribute_errors_to(self, stepped: SteppedProgram) -> Iterator[None]:
        """If a program fails in this block, drop it if it is optional, else name it in the error if several run."""
        try:
            yield
        except UnsteppableError as error:  # even for an optional program, because this is not a failure
            self.notes[stepped.program.executable] = error.reason
            raise
        except StudentError as error:
            if stepped.program.executable in self.optional:
                self._stepped = [other for other in self._stepped if other is not stepped]
                stepped.stepper.process.kill()
                raise _OptionalProgramLost from None
            raise self._error_of(stepped.program, error) from None


def _sum(counts: Iterable[dict[str, int]]) -> Counter[str]:
    return sum(map(Counter, counts), Counter[str]())
