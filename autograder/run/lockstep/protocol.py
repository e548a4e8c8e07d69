"""The messages between stepper and host: one JSON object per line, over two inherited pipes.

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

`lockstep_host/channels.py` defines the names of channels. An event is an instant of ROS time, with the number of
messages that the grader and other programs have sent on each channel that the program reads. In a command, each topic
is in at most one event. The reply contains how many messages the program sent in each event. If the program has created
an endpoint or a timer, the reply has fewer events than the command, and the others have to be sent again. The stepper
starts the host with the ROS time at which the program starts.

The host shares a process with the student's code, which may forge any of its lines. So lines are limited in size, and
those that do not match these records are refused. They only shorten waits and explain failures. No points depend on
them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

START_NS = 100 * 10**9  # ROS time at which a program starts; 0 would mean "time is not known yet"
MAX_LINE = 64 * 1024  # bytes
MAX_TEXT = 8 * 1024  # characters of each text in a line that are kept
MAX_COUNT = 2**63 - 1  # the largest number of messages, or of nanoseconds of ROS time
REASONS = ("thread", "clock", "sleep")  # why a program cannot be stepped
WAITS = ("thread", "group", "spin")  # why a wait never ends
PHASES = ("import", "start", "spin")  # of a program

Event = tuple[int, Mapping[str, int]]
"""An instant of ROS time in ns, and the messages that were sent to the program since its last event, by channel."""


class ProtocolError(Exception):
    """A line of the host is not a message of this protocol."""


@dataclass(frozen=True)
class Description:
    """The student's nodes, as the host describes them."""

    nodes: tuple[str, ...] = ()  # fully qualified names
    timers: tuple[int, ...] = ()  # periods in nanoseconds
    writers: tuple[tuple[str, int], ...] = ()  # each publisher's channel, and how many subscriptions it is matched with
    # Each subscription's channels, and how many publishers it is matched with, or None if that is unknown.
    readers: tuple[tuple[tuple[str, ...], int | None], ...] = ()
    clients: tuple[tuple[str, bool], ...] = ()  # the channel of each client's requests, and whether it has a server
    servers: tuple[str, ...] = ()  # the channel of each service's requests
    early: dict[str, int] = field(default_factory=dict)  # number of messages sent before the first step, by channel
    kept: dict[str, int] = field(
        default_factory=dict
    )  # how many messages its publishers keep for late readers, by channel
    prefix: str = ""  # prefix of the process's GUIDs

    @cached_property
    def reads(self) -> frozenset[str]:
        """Every channel from which the program takes messages."""
        subscribed = {channel for channels, _ in self.readers for channel in channels}
        return frozenset(
            {*subscribed, *self.servers, *(response_channel(name, self.prefix) for name, _ in self.clients)}
        )


@dataclass(frozen=True)
class Reply:
    """A finished step."""

    sent: tuple[dict[str, int], ...]  # for each finished event, how many messages the nodes have sent, by channel
    lost: tuple[str, ...] = ()  # channels on which announced messages did not arrive in time
    changed: bool = False  # whether endpoints or timers exist that are not in the last description
    wake: int | None = None  # when the program wakes up next for anything but a timer
    due: int | None = None  # when something in the program is due next; 0 if that is unknown
    notes: tuple[str, ...] = ()  # why the program may also run between steps: some of `REASONS`


@dataclass(frozen=True)
class Crash:
    """The exception that ended the student's program; `phase` is import, start or spin."""

    phase: str
    type: str
    message: str
    traceback: str


@dataclass(frozen=True)
class Deadlock:
    """A call that will never return. `name` is the name of its service or action, or empty.

    `reason` tells why the answer is never taken: thread (the only thread is in the call), group (the callback group is
    busy) or spin (nothing spins yet).
    """

    what: str
    name: str
    reason: str


def response_channel(request: str, prefix: str) -> str:
    """Return the channel on which the clients of one process receive the responses to requests on another channel."""
    return f"{request.removesuffix('request')}response {prefix}"


def parse(line: bytes) -> tuple[str, Any]:
    """Return the name of a line's event and its record. Raise a ProtocolError if the line is invalid.

    The record is a `Description`, `Reply`, `Crash` or `Deadlock`, one of `REASONS` for `unsteppable`, or None.
    """
    if len(line) > MAX_LINE or not line.endswith(b"\n"):
        raise ProtocolError("the line is too long, or was cut short")
    try:
        data = json.loads(line)
        event = data.pop("event")
        return event, _RECORDS[event](**data)
    except (ValueError, TypeError, AttributeError, LookupError, RecursionError):
        raise ProtocolError("the line is not a valid event") from None


def _description(**data: Any) -> Description:
    return Description(
        nodes=_texts(data["nodes"]),
        timers=tuple(map(_count, data["timers"])),
        writers=tuple((_text(channel), _count(peers)) for channel, peers in data["writers"]),
        readers=tuple((_texts(names), None if peers is None else _count(peers)) for names, peers in data["readers"]),
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
    """Return a text, or only its end if it is too long."""
    if not isinstance(value, str):
        raise TypeError
    return value[-MAX_TEXT:]


def _texts(values: Any) -> tuple[str, ...]:
    return tuple(map(_text, values))


def _count(value: Any) -> int:
    if type(value) is not int or not 0 <= value <= MAX_COUNT:  # a bool is not a count
        raise TypeError
    return value


def _counts(values: Any) -> dict[str, int]:
    return {channel: _count(value) for channel, value in values.items()}


def _one_of(words: tuple[str, ...], word: Any) -> str:
    return words[words.index(word)]
