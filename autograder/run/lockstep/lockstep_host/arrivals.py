"""Waits in real time for announced messages that have not arrived yet.

Once all messages have arrived, callbacks run in the order in which they were created. Without the wait, they would run
in the order in which messages happen to arrive.
"""

from __future__ import annotations

import time
from typing import Any

from rclpy.exceptions import InvalidHandle
from rclpy.executors import Executor
from rclpy.impl.implementation_singleton import rclpy_implementation

from .message_counts import MessageCounts, Reader, belongs_to

LOSS_SECONDS = 5.0  # s of real time without progress, after which announced messages count as lost
OVERFLOW_SECONDS = 0.3  # the same if more messages were announced than the queue holds, because DDS drops some of them

UnreadReaders = list[tuple[Reader, Any]]
"""Readers with unread messages, each with its entity."""


class Arrivals:
    """The waits for the unread messages of one `MessageCounts`.

    Attributes:
        lost: channels on which announced messages did not arrive. The host replaces the list when it has reported it.
        may_come_late: whether messages count as lost. A busy machine may still deliver them.
    """

    def __init__(self, counts: MessageCounts) -> None:
        self.lost: list[str] = []
        self.may_come_late = False
        self._counts = counts
        self._progress = 0.0

    def record_progress(self) -> None:
        """Record that the program has advanced. Perhaps it has only now sent the messages for which it waits."""
        self._progress = time.monotonic()

    def wait(self, executor: Executor) -> UnreadReaders:
        """Wait for the unread messages whose callbacks an executor can run now. Return their readers."""
        unread_readers = self._unread_readers(executor)
        for reader, entity in unread_readers:
            remaining_seconds = self._progress + _max_wait(reader) - time.monotonic()
            wait_for(reader, entity, executor.context, remaining_seconds)
        return unread_readers

    def drop_overdue(self, unread_readers: UnreadReaders) -> None:
        """Count messages as lost if they have not arrived in time."""
        elapsed = time.monotonic() - self._progress
        lost = [reader for reader, _ in unread_readers if elapsed > _max_wait(reader)]
        self.lost += [reader.channels[0] for reader in lost if not _overflows(reader)]
        self.may_come_late |= bool(lost)
        self._counts.drop(lost)

    def _unread_readers(self, executor: Executor) -> UnreadReaders:
        nodes = executor.get_nodes()
        unread_readers = []
        for reader in list(self._counts.unread_readers):
            entity = reader.entity
            if entity is None:
                self._counts.unread_readers.discard(reader)
            elif any(belongs_to(entity, node) for node in nodes) and executor.can_execute(entity):
                unread_readers.append((reader, entity))
        return unread_readers


def _overflows(reader: Reader) -> bool:
    return 0 < reader.depth < reader.unread


def _max_wait(reader: Reader) -> float:
    return OVERFLOW_SECONDS if _overflows(reader) else LOSS_SECONDS


def wait_for(reader: Reader, entity: Any, context: Any, seconds: float) -> bool:
    """Wait at most `seconds` of real time until a message has arrived for a reader. Return whether one has."""
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
