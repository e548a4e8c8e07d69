"""The order in which programs in lockstep run.

A step up to an instant t of ROS time has two phases: t - 1 ns, for what was due before t, and t. A phase consists of
rounds. In a round, the programs have their turns in the order in which they were named. A program has a turn if
messages were sent to it. In the first round at t, a program also has a turn if something in it is due. If it is the
only program, the same applies at t - 1 ns. In a turn, it takes exactly the messages that were sent before the turn, and
runs what is due. A phase ends when no message is left. A step of length 0 is one phase, in which nothing is due.

Only this order is observable, so a program that has nothing to do is not run. If no message can return to its sender by
way of other programs, all turns of the first program in the flow are known in advance. It then runs once for all turns
of a step, after which those of the next program are known.
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
from autograder.run.lockstep.protocol import response_channel

_PARAMETER_EVENTS = "/parameter_events"  # every program publishes them, and no description names them


class Place(NamedTuple):
    """The position of a turn in a step. Positions compare in the order of the turns."""

    phase: int = -1  # the grader sends before each phase
    round: int = 0
    number: int = 0  # number of the program


class Turn(NamedTuple):
    """A program's turn: its place, its instant, and the number of messages that it takes from each channel."""

    place: Place
    instant: int
    messages: Mapping[str, int]


@dataclass(eq=False)
class SteppedProgram:
    """One program of a harness in lockstep; `number` is its index among the programs of the harness."""

    number: int
    program: Program
    stepper: Stepper
    description: Description = field(default_factory=Description)  # the last description of its nodes
    # Messages for it, with the turns in which they were sent.
    inbox: list[tuple[Place, Counter[str]]] = field(default_factory=list)
    wake: int | None = None  # as in `Reply`
    due: int | None = 0  # as in `Reply`

    def is_due(self, instant: int) -> bool:
        """Return whether something in it may be due."""
        return self.due is not None and self.due <= instant

    def take(self, before: Place | None = None) -> Counter[str]:
        """Remove the messages that were sent before a place, or all, from the inbox. Return their counts by channel."""
        entries = [entry for entry in self.inbox if before is None or entry[0] < before]
        self.inbox = [entry for entry in self.inbox if entry not in entries]
        return sum((counts for _, counts in entries), Counter())


def turns_of(program: SteppedProgram, instants: Sequence[int], *, alone: bool) -> list[Turn]:
    """Return a program's turns in a step with a phase at each instant. All messages for it must be in its inbox.

    After its first turn, it is not known what is due, so it has a turn in the first round of every later phase.
    """
    turns: list[Turn] = []
    for phase, instant in enumerate(instants):
        is_due = (alone or phase == len(instants) - 1) and (bool(turns) or program.is_due(instant))
        place = Place(phase, 0, program.number)
        while is_due or any(sent < Place(phase + 1) for sent, _ in program.inbox):
            messages = program.take(place)
            if messages or is_due:
                turns.append(Turn(place, instant, messages))
            is_due, place = False, place._replace(round=place.round + 1)
    return turns


def batches(turns: Iterable[Turn]) -> list[list[Turn]]:
    """Group the turns of one program into lists, so that it can run once for each list.

    The program holds back the messages of later turns by subscription, so only one turn of a list may have messages on
    a topic. Also, the queue of a subscription could not hold the messages of several turns.
    """
    groups: list[list[Turn]] = []
    group_topics: set[str] = set()
    for turn in turns:
        topics = set(map(channels.topic_of, turn.messages))
        if not groups or topics & group_topics:
            groups.append([])
            group_topics = set()
        groups[-1].append(turn)
        group_topics |= topics
    return groups


def flow(programs: Sequence[SteppedProgram]) -> list[SteppedProgram] | None:
    """Return programs in an order in which none can send messages to an earlier one, or None if that is impossible."""
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
    """Return whether a program may send messages to another one, or publishes on one of the other one's topics."""
    written = {channel for channel, _ in sender.writers}
    sent = {*written, *(channel for channel, _ in sender.clients)}
    sent.update(response_channel(name, receiver.prefix) for name in sender.servers)
    shared = {*map(channels.topic_of, written)} & {channels.topic_of(channel) for channel, _ in receiver.writers}
    reads_parameter_events = any(channels.topic_of(channel) == _PARAMETER_EVENTS for channel in receiver.reads)
    return bool(sent & receiver.reads or shared or reads_parameter_events)
