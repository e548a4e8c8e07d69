"""Counts the messages that this program has sent on each channel, and those that its readers have not taken yet.

A reader takes messages of one kind. It is a subscription, a service, a client, or a part of an action server or client.
"""

from __future__ import annotations

import time
import weakref
from collections import Counter
from collections.abc import Iterable
from typing import Any

from rclpy.event_handler import EventHandler
from rclpy.exceptions import InvalidHandle
from rclpy.impl.implementation_singleton import rclpy_implementation

from . import channels

_take_message = rclpy_implementation.Subscription.take_message

NOT_COUNTED = frozenset({"/rosout", "/clock"})  # topics whose messages are not counted


class Reader:
    """Takes the messages of some channels.

    Attributes:
        channels: the channels that it reads.
        part: its part of an action's entity, and its index in the result of the entity's `is_ready`.
        transient_local: whether it receives the messages that transient-local writers keep.
        unread: the number of messages that were sent to it and that it has not taken, counted once it is matched.
        matched_ns: the system time in ns at which it was matched with its writers, or 0.
        held_back: whether messages that have arrived, but are not counted yet, have to wait.
        depth: the number of messages that its queue holds; 0 if nothing is dropped.
    """

    def __init__(
        self,
        entity: Any,
        names: tuple[str, ...],
        *,
        part: tuple[str, int] = ("", 0),
        depth: int = 0,
        transient_local: bool = False,
    ) -> None:
        self._entity = weakref.ref(entity)
        self.channels = names
        self.part = part
        self.depth = depth
        self.transient_local = transient_local
        self.unread = 0
        self.matched_ns = 0
        self.held_back = False

    @property
    def entity(self) -> Any:
        """The rclpy object, or None once it is destroyed."""
        entity = self._entity()
        return entity if entity is not None and is_alive(entity) else None


class MessageCounts:
    """The readers and the counts of this process.

    Attributes:
        readers: the readers, each by the address of its C object and its part.
        unreported: the number of messages on each channel that the grader does not know yet.
        kept: the number of messages that transient-local writers keep for late readers, by channel.
        unread_readers: the readers that have unread messages.
        is_exact: whether all messages that readers took were counted.
        is_complete: whether the program runs only because of timers and counted messages.
    """

    def __init__(self) -> None:
        self.readers: dict[tuple[int, str], Reader] = {}
        self.unreported: Counter[str] = Counter()
        self.kept: Counter[str] = Counter()
        self.unread_readers: set[Reader] = set()
        self._by_channel: dict[str, list[Reader]] = {}
        self._held_back_readers: list[Reader] = []
        self.is_exact = True
        self.is_complete = False

    def add(self, handle: Any, reader: Reader) -> None:
        """Add a new reader, which belongs to a C object."""
        self.readers[(handle.pointer, reader.part[0])] = reader
        if not reader.part[0]:
            reader.entity.lockstep_reader = reader

    def count_sent(self, channel: str, depth: int = 0) -> None:
        """Count a message that this program has sent. `depth` is the number that a transient-local writer keeps."""
        self.unreported[channel] += 1
        if depth:
            self.kept[channel] = min(self.kept[channel] + 1, depth)
        self._add_unread(channel, 1)

    def count_received(self, pending: dict[str, int]) -> None:
        """Count messages that the grader and other programs have sent."""
        for channel, count in pending.items():
            self._add_unread(channel, count)

    def hold_back(self, channels: Iterable[str]) -> None:
        """From now on, hold back messages that are not counted yet on these channels, and only on these."""
        for reader in self._held_back_readers:
            reader.held_back = False
        self._held_back_readers = [reader for channel in channels for reader in self._by_channel.get(channel, ())]
        for reader in self._held_back_readers:
            reader.held_back = True

    def is_silent(self, entity: Any) -> bool:
        """Return whether rclpy need not check an entity, because it has no message to take yet."""
        reader = getattr(entity, "lockstep_reader", None)
        if reader is None:
            return self.is_complete and type(entity) is EventHandler
        return bool(reader.unread <= 0 and (reader.held_back or (self.is_complete and reader.matched_ns)))

    def count_taken(self, handle: Any, part: str) -> None:
        """Count a message that one part of a C object has taken."""
        reader = self.readers.get((handle.pointer, part))
        if reader is not None and reader.matched_ns:
            reader.unread -= 1
            self.is_exact &= reader.unread >= 0
            if reader.unread <= 0:
                self.unread_readers.discard(reader)

    def match(self, prefix: str, kept: dict[str, int], early: dict[str, int]) -> None:
        """Begin to count messages for new readers, which are now matched with their writers.

        Early requests, and the messages that transient-local writers keep in this and other programs, count as unread.

        Args:
            prefix: the prefix of this process's GUIDs.
            kept: the number of messages that transient-local writers of other programs keep, by channel.
            early: the number of requests and responses that others sent before the first step, by channel.
        """
        kept = dict(Counter(kept) + self.kept)
        early = dict(Counter(early) + self.unreported)
        for key, reader in list(self.readers.items()):
            entity = reader.entity
            if entity is None:
                del self.readers[key]
                self.unread_readers.discard(reader)
            elif not reader.matched_ns:
                reader.matched_ns = time.time_ns()
                if reader.transient_local:
                    reader.unread = min(reader.depth, sum(kept.get(channel, 0) for channel in reader.channels))
                elif reader.depth:
                    if not reader.part[0]:
                        _discard_messages(entity)
                else:
                    reader.unread = sum(early.get(channel, 0) for channel in reader.channels)
                if reader.unread > 0:
                    self.unread_readers.add(reader)
        self._by_channel = {}
        for reader in self.readers.values():
            for channel in channels.with_process_prefix(reader.channels, prefix):
                self._by_channel.setdefault(channel, []).append(reader)

    def drop(self, readers: Iterable[Reader]) -> None:
        """Count the unread messages of readers as lost."""
        for reader in list(readers):
            reader.unread = 0
            self.unread_readers.discard(reader)

    def flush(self) -> dict[str, int]:
        """Return the number of messages that were sent since the last call, by channel."""
        unreported, self.unreported = dict(self.unreported), Counter()
        return unreported

    def _add_unread(self, channel: str, count: int) -> None:
        for reader in self._by_channel.get(channel, ()):
            reader.unread += count
            if reader.unread > 0:
                self.unread_readers.add(reader)


def _discard_messages(subscription: Any) -> None:
    """Discard the messages that arrived before the reader was matched."""
    while _take_message(subscription.handle, subscription.msg_type, True) is not None:
        pass


def belongs_to(entity: Any, node: Any) -> bool:
    """Return whether an entity belongs to a node."""
    kinds = (node.subscriptions, node.services, node.clients, node.waitables)
    return any(entity is other for kind in kinds for other in kind)


def is_alive(entity: Any) -> bool:
    """Return whether an rclpy object has not been destroyed."""
    try:
        with entity.handle if hasattr(entity, "handle") else entity:
            return True
    except InvalidHandle:
        return False
