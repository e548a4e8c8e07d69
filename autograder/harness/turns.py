"""The order in which programs in lockstep run.

A step that ends at ROS time t has two phases: one at t - 1 ns, for what was due before t, and one at t. A phase
consists of rounds. In a round, the programs take turns in the order in which they were named. A program has a turn if
messages were sent to it. In the first round at t, a program also has a turn if something in it is due. A program that
is alone in its harness has such a turn at t - 1 ns as well. In a turn, a program takes exactly the messages that were
sent before the turn, and runs what is due. A phase ends when no messages are left. A step of length 0 has only one
phase, in which nothing is due.

Only this order is observable, so a program that has nothing to do is not run. If no message can return to its sender
via other programs, all turns of the first program in the flow are known in advance. That program then runs once for all
its turns in a step, and afterwards the turns of the next program are known.
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

_PARAMETER_EVENTS = "/parameter_events"  # every program publishes on this topic, but no description lists it


class Place(NamedTuple):
    """The position of a turn in a step. Places have the same order as the turns."""

    phase: int = -1  # -1 is before all turns of a step: the grader sends its messages then
    round: int = 0
    number: int = 0  # the program's number, as in `SteppedProgram`


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
    # For each turn that sent messages to it: the place of the turn, and the number of messages on each channel.
    inbox: list[tuple[Place, Counter[str]]] = field(default_factory=list)
    wake: int | None = None  # as in `Reply`
    due: int | None = 0  # as in `Reply`

    def is_due(self, instant: int) -> bool:
        """Return whether something in this program may be due at an instant."""
        return self.due is not None and self.due <= instant

    def take(self, before: Place | None = None) -> Counter[str]:
        """Remove the messages that were sent before a place from the inbox. Return their counts by channel.

        If `before` is None, all messages are removed.
        """
        entries = [entry for entry in self.inbox if before is None or entry[0] < before]
        self.inbox = [entry for entry in self.inbox if entry not in entries]
        return sum((counts for _, counts in entries), Counter())


def turns_of(program: SteppedProgram, instants: Sequence[int], *, alone: bool) -> list[Turn]:
    """Return a program's turns in a step with a phase at each instant.

    All messages for the program must be in its inbox. What is due after its first turn is not known, so it also has a
    turn in the first round of every later phase.
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
    """Group the turns of one program into batches, so that the program can run once for each batch.

    The program holds back the messages of later turns separately for each subscription, so only one turn of a batch may
    have messages on a given topic. Besides, a subscription's queue may be too short for the messages of several turns.
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
    """Return the programs in an order in which none can affect an earlier one, or None if there is no such order."""
    senders_to = {
        receiver: [
            sender
            for sender in programs
            if sender is not receiver and _may_affect(sender.description, receiver.description)
        ]
        for receiver in programs
    }
    try:
        return list(TopologicalSorter(senders_to).static_order())
    except CycleError:
        return None


def _may_affect(sender: Description, receiver: Description) -> bool:
    """Return whether the first program may send messages to the second, or both publish on the same topic."""
    written_channels = {channel for channel, _ in sender.writers}
    sent_channels = {*written_channels, *(channel for channel, _ in sender.clients)}
    sent_channels.update(response_channel(name, receiver.prefix) for name in sender.servers)
    shared_topics = {*map(channels.topic_of, written_channels)} & {
        channels.topic_of(channel) for channel, _ in receiver.writers
    }
    reads_parameter_events = any(channels.topic_of(channel) == _PARAMETER_EVENTS for channel in receiver.reads)
    return bool(sent_channels & receiver.reads or shared_topics or reads_parameter_events)
