"""Message counts: how many messages this program has sent on each channel, and how many its readers have still to take.

A reader is what takes messages of one kind: a subscription, a service, a client, or one of the parts of an action
server or client. It owes as many takes as messages were sent to it, by the grader, by other programs or by its own.
"""

from __future__ import annotations

import time
import weakref
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from rclpy.exceptions import InvalidHandle
from rclpy.impl.implementation_singleton import rclpy_implementation

from . import channels

_take_message = rclpy_implementation.Subscription.take_message

NOT_COUNTED = frozenset({"/rosout", "/clock"})


class Reader:
    """What takes the messages of some channels.

    Attributes:
        part: which part of an action's entity it is, and its index in what the entity's `is_ready` returns.
        owes: messages that were sent to it and that it has not taken; meaningless until it has met its writers.
        met: when it met them, in ns of system time; 0 before.
        depth: how many messages its queue holds; 0 where nothing is dropped.
    """

    def __init__(
        self,
        entity: Any,
        read: tuple[str, ...],
        *,
        part: tuple[str, int] = ("", 0),
        depth: int = 0,
        latched: bool = False,
    ) -> None:
        self._entity = weakref.ref(entity)
        self.channels = read
        self.part = part
        self.depth = depth
        self.latched = latched
        self.owes = 0
        self.met = 0

    @property
    def entity(self) -> Any:
        """The rclpy object, or None once it is gone."""
        entity = self._entity()
        return entity if entity is not None and is_alive(entity) else None


class MessageCounts:
    """All readers of this process and all counts."""

    def __init__(self) -> None:
        self.readers: dict[tuple[int, str], Reader] = {}  # by address of the C object, and part
        self.fresh: Counter[str] = Counter()  # sent since the grader was last told
        self.kept: Counter[str] = Counter()  # what latched writers hold for readers that come late
        self.owing: set[Reader] = set()
        self._by_channel: dict[str, list[Reader]] = {}

    def add(self, handle: Any, reader: Reader) -> None:
        """Know a new reader."""
        self.readers[(handle.pointer, reader.part[0])] = reader

    def sent(self, channel: str, depth: int = 0) -> None:
        """Book a message that this program has sent; `depth` is how many a latched writer keeps."""
        self.fresh[channel] += 1
        if depth:
            self.kept[channel] = min(self.kept[channel] + 1, depth)
        self._owe(channel, 1)

    def told(self, mail: dict[str, int]) -> None:
        """Book messages that others have sent."""
        for channel, count in mail.items():
            self._owe(channel, count)

    def took(self, handle: Any, part: str) -> None:
        """Book a message that was taken."""
        reader = self.readers.get((handle.pointer, part))
        if reader is not None and reader.met:
            reader.owes -= 1
            if reader.owes <= 0:
                self.owing.discard(reader)

    def meet(self, prefix: str, kept: dict[str, int], early: dict[str, int]) -> None:
        """Begin to count for the readers that are new: their writers see them now.

        They owe what latched writers (`kept`, and this program's own) keep for them, and requests that were sent
        before there was anyone to step. `prefix` names this process.
        """
        kept = dict(Counter(kept) + self.kept)
        early = dict(Counter(early) + self.fresh)
        for key, reader in list(self.readers.items()):
            entity = reader.entity
            if entity is None:
                del self.readers[key]
                self.owing.discard(reader)
            elif not reader.met:
                reader.met = time.time_ns()
                if reader.latched:
                    reader.owes = min(reader.depth, sum(kept.get(channel, 0) for channel in reader.channels))
                elif reader.depth:
                    if not reader.part[0]:
                        _empty(entity)
                else:
                    reader.owes = sum(early.get(channel, 0) for channel in reader.channels)
                if reader.owes > 0:
                    self.owing.add(reader)
        self._by_channel = {}
        for reader in self.readers.values():
            for channel in channels.of(reader.channels, prefix):
                self._by_channel.setdefault(channel, []).append(reader)

    def forgive(self, readers: Iterable[Reader]) -> None:
        """Take what did not come for lost."""
        for reader in list(readers):
            reader.owes = 0
            self.owing.discard(reader)

    def flush(self) -> dict[str, int]:
        """Return what was sent since the last time."""
        fresh, self.fresh = dict(self.fresh), Counter()
        return fresh

    def alive(self) -> Iterator[tuple[Reader, Any]]:
        """Yield the readers whose entities are there, with these."""
        for reader in list(self.readers.values()):
            entity = reader.entity
            if entity is not None:
                yield reader, entity

    def _owe(self, channel: str, count: int) -> None:
        for reader in self._by_channel.get(channel, ()):
            reader.owes += count
            if reader.owes > 0:
                self.owing.add(reader)


def wait_for(reader: Reader, entity: Any, context: Any, seconds: float) -> bool:
    """Wait until a message has come in for a reader, at most `seconds`; return whether one has."""
    try:
        with entity.handle if hasattr(entity, "handle") else entity, context.handle:
            return _wait_for(reader, entity, context, int(max(0.0, seconds) * 1e9))
    except InvalidHandle:
        return False


def _wait_for(reader: Reader, entity: Any, context: Any, nanoseconds: int) -> bool:
    name, index = reader.part
    if name:
        counts = entity.get_num_entities()
        numbers = [counts.num_subscriptions, counts.num_guard_conditions, counts.num_timers]
        numbers += [counts.num_clients, counts.num_services, counts.num_events]
        deadline = time.monotonic_ns() + nanoseconds
        while True:
            wait_set = rclpy_implementation.WaitSet(*numbers, context.handle)
            wait_set.clear_entities()
            entity.add_to_wait_set(wait_set)
            wait_set.wait(max(0, deadline - time.monotonic_ns()))
            ready = (entity._handle if hasattr(entity, "_handle") else entity._client_handle).is_ready(wait_set)
            if ready[index] or time.monotonic_ns() >= deadline:
                return bool(ready[index])
    kind = type(entity).__name__
    subscriptions, clients, services = kind == "Subscription", kind == "Client", kind == "Service"
    wait_set = rclpy_implementation.WaitSet(int(subscriptions), 0, 0, int(clients), int(services), 0, context.handle)
    wait_set.clear_entities()
    add = {"Subscription": wait_set.add_subscription, "Client": wait_set.add_client, "Service": wait_set.add_service}
    add[kind](entity.handle)
    wait_set.wait(nanoseconds)
    return bool(wait_set.get_ready_entities(kind.lower()))


def _empty(subscription: Any) -> None:
    """Drop what came before the reader's time."""
    while _take_message(subscription.handle, subscription.msg_type, True) is not None:
        pass


def holds(node: Any, entity: Any) -> bool:
    """Return whether an entity belongs to a node."""
    kinds = (node.subscriptions, node.services, node.clients, node.waitables)
    return any(entity is one for kind in kinds for one in kind)


def is_alive(entity: Any) -> bool:
    """Return whether an rclpy object has not been destroyed."""
    try:
        with entity.handle if hasattr(entity, "handle") else entity:
            return True
    except InvalidHandle:
        return False
