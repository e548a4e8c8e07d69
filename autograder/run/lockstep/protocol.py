"""The messages between stepper and host: a JSON object a line, over two inherited pipes.

    stepper -> host   {"op": "describe"}
                      {"op": "match", "kept": {CHANNEL: COUNT}, "early": {CHANNEL: COUNT}}
                      {"op": "step", "events": [[NANOSECONDS, {CHANNEL: NEW MESSAGES}], ...]}
    host -> stepper   {"event": "ready"}                  once, when the node first waits for work
                      {"event": "description", ...}
                      {"event": "matched"}
                      {"event": "done", "sent": [{CHANNEL: NEW MESSAGES}, ...], "lost": [CHANNEL, ...],
                       "changed": BOOL, "wake": NANOSECONDS, "due": NANOSECONDS, "notes": [REASON, ...]}
                      {"event": "unsteppable", "reason": ...}
                      {"event": "deadlock", "what": ..., "name": ..., "reason": ...}
                      {"event": "crash", "phase": ..., "type": ..., "message": ..., "traceback": ...}

`lockstep_host/channels.py` names channels. An event is an instant of ROS time, and counts what the grader and other
programs have sent on the channels that the program reads; no topic is in two events of one command. The reply says what
was sent in each event. It has fewer events than the command if the program has made an endpoint or a timer: the others
are to be sent again. The stepper starts the host with the ROS time at which the program starts.

The host shares a process with the student's code, which may forge any event. So every event is bounded in size and
parsed into these records, or refused. They serve only to wait less and to explain; no point depends on them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

START_NS = 100 * 10**9  # ROS time at which a program starts; 0 would mean "time is not known yet"
MAX_LINE = 64 * 1024
MAX_TEXT = 8 * 1024
MAX_COUNT = 2**63 - 1  # of messages, and of nanoseconds of ROS time
REASONS = ("thread", "clock", "sleep")  # why a program cannot be stepped
WAITS = ("thread", "group", "spin")  # why a wait never ends
PHASES = ("import", "start", "spin")

Event = tuple[int, Mapping[str, int]]
"""An instant of ROS time in ns, and the messages that were sent to the program since its last event, by channel."""


class ProtocolError(Exception):
    """The host's line is no message of this protocol."""


@dataclass(frozen=True)
class Description:
    """What the host sees of the student's nodes."""

    nodes: tuple[str, ...] = ()  # fully qualified names
    timers: tuple[int, ...] = ()  # periods in nanoseconds
    writers: tuple[tuple[str, int], ...] = ()  # the channel of each publisher, and how many subscriptions it sees
    # The channels of each subscription, and how many publishers it sees (None: that cannot be told).
    readers: tuple[tuple[tuple[str, ...], int | None], ...] = ()
    clients: tuple[tuple[str, bool], ...] = ()  # the channel of each client's requests, and whether it sees a server
    servers: tuple[str, ...] = ()  # the channel of each service's requests
    early: dict[str, int] = field(default_factory=dict)  # messages that were sent before the first step, by channel
    kept: dict[str, int] = field(default_factory=dict)  # messages that transient-local publishers hold, by channel
    prefix: str = ""  # of the process's GUIDs

    @cached_property
    def reads(self) -> frozenset[str]:
        """Every channel that the program takes messages from."""
        subscribed = {channel for channels, _ in self.readers for channel in channels}
        return frozenset({*subscribed, *self.servers, *(answers(name, self.prefix) for name, _ in self.clients)})


@dataclass(frozen=True)
class Reply:
    """A finished step."""

    sent: tuple[dict[str, int], ...]  # how many messages the nodes have sent in each event that is over, by channel
    lost: tuple[str, ...] = ()  # channels on which messages that were announced did not arrive in time
    changed: bool = False  # whether there are endpoints or timers that the last description did not name
    wake: int | None = None  # the next instant at which something in the program continues, besides its timers
    due: int | None = None  # from when on the program has something to do by itself; 0 if it may at any time
    notes: tuple[str, ...] = ()  # why steps are not all that moves the program; one of `REASONS`


@dataclass(frozen=True)
class Crash:
    """The exception that ended the student's program; `phase` is import, start or spin."""

    phase: str
    type: str
    message: str
    traceback: str


@dataclass(frozen=True)
class Deadlock:
    """A call that will never return; `name` is the service or action that it asks, or empty.

    `reason` is what keeps the answer from being taken: thread (the only one is in the call), group (the callback group)
    or spin (nothing spins yet).
    """

    what: str
    name: str
    reason: str


def answers(request: str, prefix: str) -> str:
    """Return the channel of the responses to requests on a channel, to the clients of one process."""
    return f"{request.removesuffix('request')}response {prefix}"


def parse(line: bytes) -> tuple[str, Any]:
    """Return which event a line is, and its record, or raise a ProtocolError.

    The record is a `Description`, `Reply`, `Crash` or `Deadlock`, for `unsteppable` one of `REASONS`, for others None.
    """
    if len(line) > MAX_LINE or not line.endswith(b"\n"):
        raise ProtocolError("the line is too long, or was cut short")
    try:
        data = json.loads(line)
        event = data.pop("event")
        return event, _RECORDS[event](**data)
    except (ValueError, TypeError, AttributeError, LookupError, RecursionError):
        raise ProtocolError("the line is no event") from None


def _description(**data: Any) -> Description:
    return Description(
        nodes=_texts(data["nodes"]),
        timers=tuple(map(_count, data["timers"])),
        writers=tuple((_text(channel), _count(seen)) for channel, seen in data["writers"]),
        readers=tuple((_texts(names), None if seen is None else _count(seen)) for names, seen in data["readers"]),
        clients=tuple((_text(channel), ready is True) for channel, ready in data["clients"]),
        servers=_texts(data["servers"]),
        early=_counts(data["early"]),
        kept=_counts(data["kept"]),
        prefix=_text(data["prefix"]),
    )


def _reply(sent: Any, lost: Any, changed: Any, wake: Any, due: Any, notes: Any) -> Reply:
    return Reply(
        tuple(map(_counts, sent)),
        _texts(lost),
        changed is True,
        None if wake is None else _count(wake),
        None if due is None else _count(due),
        tuple(_one_of(REASONS, reason) for reason in notes),
    )


_RECORDS: dict[str, Callable[..., Any]] = {
    "ready": lambda: None,
    "matched": lambda: None,
    "description": _description,
    "done": _reply,
    "unsteppable": lambda reason: _one_of(REASONS, reason),
    "deadlock": lambda what, name, reason: Deadlock(_text(what), _text(name), _one_of(WAITS, reason)),
    "crash": lambda phase, type, message, traceback: Crash(
        _one_of(PHASES, phase), _text(type), _text(message), _text(traceback)
    ),
}


def _text(value: Any) -> str:
    """Return a text, shortened to the end of it."""
    if not isinstance(value, str):
        raise TypeError
    return value[-MAX_TEXT:]


def _texts(values: Any) -> tuple[str, ...]:
    return tuple(map(_text, values))


def _count(value: Any) -> int:
    if type(value) is not int or not 0 <= value <= MAX_COUNT:  # True is no count
        raise TypeError
    return value


def _counts(values: Any) -> dict[str, int]:
    return {channel: _count(value) for channel, value in values.items()}


def _one_of(words: tuple[str, ...], word: Any) -> str:
    return words[words.index(word)]
