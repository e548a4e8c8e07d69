"""Message counts: how many messages this program has sent on each channel, and how many its readers have not taken yet.

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

NOT_COUNTED = frozenset({"/rosout", "/clock"})


class Reader:
    """What takes the messages of some channels.

    Attributes:
        channels: what it takes.
        part: which part of an action's entity it is, and its index in what the entity's `is_ready` returns.
        transient_local: whether it gets what transient-local writers hold.
        unread: messages that were sent to it and that it has not taken; counted once it is matched.
        matched_ns: when it was matched with its writers, in ns of system time; 0 before.
        held_back: whether what has come and is not counted yet waits until it is.
        depth: how many messages its queue holds; 0 where nothing is dropped.
    """

    def __init__(
        self,
        entity: Any,
        read: tuple[str, ...],
        *,
        part: tuple[str, int] = ("", 0),
        depth: int = 0,
        transient_local: bool = False,
    ) -> None:
        self._entity = weakref.ref(entity)
        self.channels = read
        self.part = part
        self.depth = depth
        self.transient_local = transient_local
        self.unread = 0
        self.matched_ns = 0
        self.held_back = False

    @property
    def entity(self) -> Any:
        """The rclpy object, or None once it is gone."""
        entity = self._entity()
        return entity if entity is not None and is_alive(entity) else None


class MessageCounts:
    """The readers and the counts of this process.

    Attributes:
        readers: by the address of the C object, and the part of it.
        fresh: messages that were sent since the grader was last told, by channel.
        kept: messages that transient-local writers hold for readers that come late, by channel.
        behind: the readers that have unread messages.
        is_exact: whether no reader ever took a message that was not counted.
        are_all: whether nothing but timers and the messages that are counted moves the program.
    """

    def __init__(self) -> None:
        self.readers: dict[tuple[int, str], Reader] = {}
        self.fresh: Counter[str] = Counter()
        self.kept: Counter[str] = Counter()
        self.behind: set[Reader] = set()
        self._by_channel: dict[str, list[Reader]] = {}
        self._held_back: list[Reader] = []
        self.is_exact = True
        self.are_all = False

    def add(self, handle: Any, reader: Reader) -> None:
        """Add a new reader, which belongs to a C object."""
        self.readers[(handle.pointer, reader.part[0])] = reader
        if not reader.part[0]:
            reader.entity.lockstep_reader = reader

    def sent(self, channel: str, depth: int = 0) -> None:
        """Count a message that this program has sent; `depth` is how many a transient-local writer holds."""
        self.fresh[channel] += 1
        if depth:
            self.kept[channel] = min(self.kept[channel] + 1, depth)
        self._add_unread(channel, 1)

    def received(self, pending: dict[str, int]) -> None:
        """Count messages that the grader and other programs have sent."""
        for channel, count in pending.items():
            self._add_unread(channel, count)

    def hold_back(self, channels: Iterable[str]) -> None:
        """From now on hold back messages on these channels, and on no others, that are not counted yet."""
        for reader in self._held_back:
            reader.held_back = False
        self._held_back = [reader for channel in channels for reader in self._by_channel.get(channel, ())]
        for reader in self._held_back:
            reader.held_back = True

    def is_silent(self, entity: Any) -> bool:
        """Return whether rclpy need not look at an entity: it has no message, or none that it is to take yet."""
        reader = getattr(entity, "lockstep_reader", None)
        if reader is None:
            return self.are_all and type(entity) is EventHandler
        return bool(reader.unread <= 0 and (reader.held_back or (self.are_all and reader.matched_ns)))

    def took(self, handle: Any, part: str) -> None:
        """Count a message that one part of a C object has taken."""
        reader = self.readers.get((handle.pointer, part))
        if reader is not None and reader.matched_ns:
            reader.unread -= 1
            self.is_exact &= reader.unread >= 0
            if reader.unread <= 0:
                self.behind.discard(reader)

    def match(self, prefix: str, kept: dict[str, int], early: dict[str, int]) -> None:
        """Begin to count for new readers, which are matched with their writers now.

        What transient-local writers hold, this program's own too, and early requests are unread messages.

        Args:
            prefix: of this process's GUIDs.
            kept: messages that transient-local writers of others hold, by channel.
            early: requests and responses that others sent before the first step, by channel.
        """
        kept = dict(Counter(kept) + self.kept)
        early = dict(Counter(early) + self.fresh)
        for key, reader in list(self.readers.items()):
            entity = reader.entity
            if entity is None:
                del self.readers[key]
                self.behind.discard(reader)
            elif not reader.matched_ns:
                reader.matched_ns = time.time_ns()
                if reader.transient_local:
                    reader.unread = min(reader.depth, sum(kept.get(channel, 0) for channel in reader.channels))
                elif reader.depth:
                    if not reader.part[0]:
                        _empty(entity)
                else:
                    reader.unread = sum(early.get(channel, 0) for channel in reader.channels)
                if reader.unread > 0:
                    self.behind.add(reader)
        self._by_channel = {}
        for reader in self.readers.values():
            for channel in channels.with_process_prefix(reader.channels, prefix):
                self._by_channel.setdefault(channel, []).append(reader)

    def drop(self, readers: Iterable[Reader]) -> None:
        """Count what did not come as lost."""
        for reader in list(readers):
            reader.unread = 0
            self.behind.discard(reader)

    def flush(self) -> dict[str, int]:
        """Return what was sent since the last call, by channel."""
        fresh, self.fresh = dict(self.fresh), Counter()
        return fresh

    def _add_unread(self, channel: str, count: int) -> None:
        for reader in self._by_channel.get(channel, ()):
            reader.unread += count
            if reader.unread > 0:
                self.behind.add(reader)


def _empty(subscription: Any) -> None:
    """Drop the messages that came before the reader was matched."""
    while _take_message(subscription.handle, subscription.msg_type, True) is not None:
        pass


def belongs_to(entity: Any, node: Any) -> bool:
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
