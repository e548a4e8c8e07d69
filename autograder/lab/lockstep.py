"""A lab in lockstep: the programs' ROS time goes on only when the grader says so."""

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
from autograder.lab.matching import connected
from autograder.lab.meeting import Lab
from autograder.lab.programs import Program, error_of
from autograder.lockstep import Description, Stepper, UnsteppableError
from autograder.lockstep.lockstep_host import channels
from autograder.lockstep.protocol import START
from autograder.sandbox import Process

DELIVERY_SECONDS = 15.0  # real time, over a whole run, for messages that were announced and have not come yet
SETTLE_SECONDS = 5.0  # real time for the names of the programs' nodes to be seen
FINEST_TICK_NS = 10_000_000
SLACK_NS = 1_000_000  # what wants to wake so shortly before the end of a step wakes at its end
ROUNDS = 1000  # in one step; programs that still answer each other then will go on for ever


class Player:
    """One program of a lab in lockstep, and the mail that it has not been told of."""

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
    """A program that may fail has failed, and the lab no longer has it."""


class LockstepLab(Lab):
    """Programs that are stepped through ROS time: faster than real time, and the same every time.

    They start at ROS time `START`. `tick_ns` hits every firing of their timers, between 10 ms and 100 ms. A step is
    lived in rounds, the programs always in the order in which they were named: first all take what was sent before,
    then their timers fire, then they take what they sent each other, until nobody has anything left to take.

    Attributes:
        notes: by executable, why steps are not all that moves a program, if so: thread, clock or sleep.
        spared: executables that may fail: the others live on without them.
    """

    spared: frozenset[str] = frozenset()
    _players: Sequence[Player] = ()

    def _start(self) -> None:
        self._now_ns = START
        self.notes: dict[str, str] = {}
        self._patience = DELIVERY_SECONDS
        for program, path in zip(self.programs, self._paths, strict=True):
            arguments = program.words(self._folder)
            stepper = Stepper(self._sandbox, path, python=sys.executable, arguments=arguments)
            self._players = [*self._players, Player(program, stepper)]
        for player in self._players:
            with suppress(_Spared), self._judging(player):
                player.stepper.wait_ready()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for player in self._players:
            player.stepper.__exit__(kind, error, trace)
        super().__exit__(kind, error, trace)

    @property
    def processes(self) -> tuple[Process, ...]:
        return tuple(player.stepper.process for player in self._players)

    @property
    def running(self) -> frozenset[str]:
        """The executables that the lab has not lost."""
        return frozenset(player.program.executable for player in self._players)

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
        wakes = [max(player.wake, earliest) for player in self._players if player.wake is not None]
        return min((wake for wake in wakes if wake < end - SLACK_NS), default=end)

    def _advance(self, dt_ns: int) -> None:
        self._now_ns += dt_ns
        if dt_ns and len(self._players) == 1:
            self._let_live(self._players[0], [self._now_ns - 1, self._now_ns])
        elif dt_ns:
            self._settle(self._now_ns - 1)
            for player in self._players:
                self._let_live(player, [self._now_ns])
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
        statuses = [player.stepper.quit() for player in self._players]
        return statuses[0]

    # Rounds.

    def _settle(self, instant: int) -> None:
        """Go round, at one instant, until nobody has mail."""
        for _ in range(ROUNDS):
            self._post(self._station.sent)
            if not any(player.mail for player in self._players):
                return
            for player in self._players:
                if player.mail:
                    self._turn(player, [instant])
        sentence = (
            f"Your nodes answered each other {ROUNDS} times without any time going by, and would go on for ever: a "
            "callback must not publish what makes it run again."
        )
        raise StudentError(Diagnosis(Kind.STUCK, sentence))

    def _let_live(self, player: Player, instants: list[int]) -> None:
        """Let one program live through instants, if it has anything to do then."""
        self._post(self._station.sent)
        if player.mail or player.idle is None or player.idle <= instants[-1]:
            self._turn(player, instants)

    def _turn(self, player: Player, instants: list[int]) -> None:
        """Let one program live through instants, and deliver what it sends."""
        if player not in self._players:
            return
        self._post(self._station.sent)
        mail, player.mail = player.mail, Counter()
        try:
            with self._judging(player):
                reply = player.stepper.step(instants, mail)
        except _Spared:
            return
        player.wake, player.idle = reply.wake, reply.idle
        for reason in reply.notes:
            self.notes.setdefault(player.program.executable, reason)
        for channel in reply.late:
            # What others of the student's programs claim to have sent may be forged; what the grader sent is not.
            if mail[channel] and channel in self._station.written.values():
                raise GraderError(f"messages that were sent to the student's node did not arrive: {channel}")
        self._post(reply.sent, but=player)
        self._expect(reply.sent)
        self._collect()
        if reply.changed:
            self._meet()

    def _post(self, sent: dict[str, int], but: Player | None = None) -> None:
        """Put into every program's mail what was sent to it."""
        for channel, count in sent.items():
            for player in self._players:
                if player is not but and channel in player.reads:
                    player.mail[channel] += count
        if sent is self._station.sent:
            self._station.sent.clear()

    def _expect(self, sent: dict[str, int]) -> None:
        for channel, count in sent.items():
            for ear in self._station.ears:
                if channel in ear.channels:
                    ear.expected += count

    def _collect(self) -> None:
        """Hear all that was said to the grader.

        A count that is never reached is forged, or the student's own QoS dropped a message. Only what arrived counts,
        and all waiting in vain has one bound.
        """
        while not self._station.hear() and self._patience > 0.0:
            began = time.monotonic()
            self._spin(0.05)
            if not self._station.hear():
                self._patience -= time.monotonic() - began
        for ear in self._station.ears:
            ear.expected = ear.count

    # Meeting.

    def _meet(self) -> None:
        while True:
            with suppress(_Spared):
                return self._meet_all()

    def _meet_all(self) -> None:
        super()._meet()
        descriptions = [player.description for player in self._players]
        for player in self._players:
            others = [description for description in descriptions if description is not player.description]
            early = _sum(description.early for description in others)
            with self._judging(player):
                player.stepper.meet(
                    _sum(description.kept for description in others),
                    {channel: count for channel, count in early.items() if not channels.is_topic(channel)},
                )
            player.idle = None  # there may be something for it to take
        for ear in self._station.ears:
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
        return connected(self._describe(), self._station)

    def _describe(self) -> list[Description]:
        found = []
        for player in self._players:
            with self._judging(player):
                found.append(player.describe())
        return found

    def _reach(self, client: Any, seconds: float) -> bool:
        channel = channels.request(client.srv_name, client.srv_type)

        def there() -> bool:
            return any(channel in player.description.servers for player in self._players)

        if not there() and not self.until(there, seconds):
            return False
        self._await(client.service_is_ready)
        return True

    @contextmanager
    def _judging(self, player: Player) -> Iterator[None]:
        """Go on without a program that failed and may; of others say which of several it was."""
        try:
            yield
        except UnsteppableError as error:  # not spared: no fault of the program's
            self.notes[player.program.executable] = error.reason
            raise
        except StudentError as error:
            if player.program.executable in self.spared:
                self._players = [other for other in self._players if other is not player]
                player.stepper.__exit__(None, None, None)
                raise _Spared from None
            raise error_of(player.program, error, len(self._players)) from None


def _sum(counts: Iterable[dict[str, int]]) -> Counter[str]:
    return sum(map(Counter, counts), Counter[str]())
