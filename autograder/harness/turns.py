"""The order in which programs in lockstep run, for one program and for many.

A step up to an instant t of ROS time has two phases: what was to happen before t, at t - 1 ns, and what happens at t. A
phase has rounds. In a round, the programs have their turns in the order in which they were named. A program has a turn
if messages were sent to it. In the first round at t, it also has one if it has something to do by itself, and at
t - 1 ns if it is the only program, too. In a turn it takes the messages that were sent before the turn and no others,
and runs what is due. A phase ends when no message is left. A step of no length is one phase, without what is due.

Nothing but this order is seen. So a program that has nothing to do is not run. And where no message can come back to
its sender by way of others, the turns of the first program in the flow are known at once: it runs for all of a step's.
Then those of the next are known.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from typing import NamedTuple

from autograder.harness.base import Program
from autograder.run.lockstep import Description, Stepper
from autograder.run.lockstep.lockstep_host import channels
from autograder.run.lockstep.protocol import answers

_PARAMETER_EVENTS = "/parameter_events"  # every program publishes them, and no description names them


class Place(NamedTuple):
    """Where a turn has its place in a step, in this order."""

    phase: int = -1  # the grader sends before each phase
    round: int = 0
    number: int = 0  # of the program


class Turn(NamedTuple):
    """A program's turn: its place and instant, and by channel the messages that it takes."""

    place: Place
    instant: int
    messages: Mapping[str, int]


@dataclass(eq=False)
class SteppedProgram:
    """One program of a harness in lockstep; `number` is its place among those that were named."""

    number: int
    program: Program
    stepper: Stepper
    description: Description = field(default_factory=Description)  # of its nodes, as last asked
    inbox: list[tuple[Place, Counter[str]]] = field(default_factory=list)  # what was sent to it, by sending turns
    wake: int | None = None  # as in `Reply`
    due: int | None = 0  # as in `Reply`

    def is_due(self, instant: int) -> bool:
        """Return whether it may have something to do by itself."""
        return self.due is not None and self.due <= instant

    def take(self, before: Place | None = None) -> Counter[str]:
        """Remove from the inbox what was sent before a place, or all, and return it by channel."""
        taken = [entry for entry in self.inbox if before is None or entry[0] < before]
        self.inbox = [entry for entry in self.inbox if entry not in taken]
        return sum((counts for _, counts in taken), Counter())


def turns_of(program: SteppedProgram, instants: Sequence[int], *, alone: bool) -> list[Turn]:
    """Return a program's turns in a step with a phase at each of the instants; all that is sent to it is in its inbox.

    After its first turn nobody knows what is due: it has a turn in the first round of every later phase.
    """
    turns: list[Turn] = []
    for phase, instant in enumerate(instants):
        by_itself = (alone or phase == len(instants) - 1) and (bool(turns) or program.is_due(instant))
        place = Place(phase, 0, program.number)
        while by_itself or any(sent < Place(phase + 1) for sent, _ in program.inbox):
            messages = program.take(place)
            if messages or by_itself:
                turns.append(Turn(place, instant, messages))
            by_itself, place = False, place._replace(round=place.round + 1)
    return turns


def batches(turns: Iterable[Turn]) -> list[list[Turn]]:
    """Return turns of one program in lists, for each of which it can run at once.

    It holds back the messages of later turns by subscription, so a topic may have messages in one turn of a list. The
    queue of a subscription could not hold those of several, either.
    """
    found: list[list[Turn]] = []
    seen: set[str] = set()
    for turn in turns:
        topics = set(map(channels.topic_of, turn.messages))
        if not found or topics & seen:
            found.append([])
            seen = set()
        found[-1].append(turn)
        seen |= topics
    return found


def flow(programs: Sequence[SteppedProgram]) -> list[SteppedProgram] | None:
    """Return programs in an order in which none can send an earlier one anything; None if there is no such order."""
    senders = {
        receiver: [
            sender
            for sender in programs
            if sender is not receiver and _reaches(sender.description, receiver.description)
        ]
        for receiver in programs
    }
    try:
        return list(TopologicalSorter(senders).static_order())
    except CycleError:
        return None


def _reaches(sender: Description, receiver: Description) -> bool:
    """Return whether a program may send another one anything, or send anybody anything on the same topic as it."""
    written = {channel for channel, _ in sender.writers}
    sent = {*written, *(channel for channel, _ in sender.clients)}
    sent.update(answers(name, receiver.prefix) for name in sender.servers)
    shared = {*map(channels.topic_of, written)} & {channels.topic_of(channel) for channel, _ in receiver.writers}
    hears_parameters = any(channels.topic_of(channel) == _PARAMETER_EVENTS for channel in receiver.reads)
    return bool(sent & receiver.reads or shared or hears_parameters)
