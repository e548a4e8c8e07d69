"""The messages between stepper and host: a JSON object a line, over two inherited pipes.

    stepper -> host   {"op": "describe"}
                      {"op": "match", "kept": {CHANNEL: COUNT}, "early": {CHANNEL: COUNT}}
                      {"op": "step", "instants": [NANOSECONDS, ...], "pending": {CHANNEL: NEW MESSAGES}}
                      {"op": "quit"}
    host -> stepper   {"event": "ready"}                  once, when the node first waits for work
                      {"event": "description", ...}
                      {"event": "matched"}
                      {"event": "done", "sent": {CHANNEL: NEW MESSAGES}, "lost": [CHANNEL, ...], "changed": BOOL,
                       "wake": NANOSECONDS, "notes": [REASON, ...]}
                      {"event": "unsteppable", "reason": ...}
                      {"event": "deadlock", "what": ..., "name": ..., "reason": ...}
                      {"event": "crash", "phase": ..., "type": ..., "message": ..., "traceback": ...}

`lockstep_host/channels.py` names channels. "pending" counts what the grader and other programs have sent on the
channels that the program reads. The stepper starts the host with the ROS time at which the program starts.

The host shares a process with the student's code, which may forge any event. So the stepper bounds every event in size
and parses it into these records. They serve only to wait less and to explain; no point depends on them.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

START_NS = 100 * 10**9  # ROS time at which a program starts; 0 would mean "time is not known yet"
MAX_LINE = 64 * 1024
MAX_TEXT = 8 * 1024
MAX_TOPICS = 256
REASONS = ("thread", "clock", "sleep")


class ProtocolError(Exception):
    """The host's line is no message of this protocol."""


@dataclass(frozen=True)
class Description:
    """What the host sees of the student's nodes.

    Attributes:
        nodes: fully qualified names.
        timers: periods in nanoseconds.
        writers: the channel of each publisher, and how many subscriptions it sees.
        readers: the channels of each subscription, and how many publishers it sees (None: that cannot be told).
        clients: the channel of each client's requests, and whether it sees a server.
        servers: the channel of each service's requests.
        early: messages that were sent before the first step, by channel.
        kept: messages that latched publishers hold, by channel.
        prefix: of the process's GUIDs.
    """

    nodes: tuple[str, ...] = ()
    timers: tuple[int, ...] = ()
    writers: tuple[tuple[str, int], ...] = ()
    readers: tuple[tuple[tuple[str, ...], int | None], ...] = ()
    clients: tuple[tuple[str, bool], ...] = ()
    servers: tuple[str, ...] = ()
    early: dict[str, int] = field(default_factory=dict)
    kept: dict[str, int] = field(default_factory=dict)
    prefix: str = ""

    def reads(self) -> frozenset[str]:
        """Return every channel that the program takes messages from."""
        subscribed = {channel for channels, _ in self.readers for channel in channels}
        return frozenset({*subscribed, *self.servers, *(answers(name, self.prefix) for name, _ in self.clients)})


@dataclass(frozen=True)
class Reply:
    """A finished step.

    Attributes:
        sent: how many messages the nodes have sent in it, by channel.
        lost: channels on which messages that were announced did not arrive in time.
        changed: whether there are endpoints or timers that the last description did not name.
        wake: the next instant at which something in the program continues, besides its timers.
        notes: why steps are not all that moves the program; one of `REASONS`.
    """

    sent: dict[str, int] = field(default_factory=dict)
    lost: tuple[str, ...] = ()
    changed: bool = False
    wake: int | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Crash:
    """The exception that ended the student's program; `phase` is import, start or spin."""

    phase: str
    type: str
    message: str
    traceback: str


@dataclass(frozen=True)
class Deadlock:
    """A call that will never return.

    Attributes:
        what: the call.
        name: the service or action that it asks, or an empty string.
        reason: what keeps the answer from being taken: thread (the only one is in the call), group (the callback group)
            or spin (nothing spins yet).
    """

    what: str
    name: str
    reason: str


def parse(line: bytes) -> dict[str, Any]:
    """Return a line's JSON object.

    Raises:
        ProtocolError: it is none, or too long.
    """
    if len(line) > MAX_LINE or not line.endswith(b"\n"):
        raise ProtocolError("the line is too long, or was cut short")
    try:
        data = json.loads(line)
    except (ValueError, RecursionError):
        raise ProtocolError("the line is no JSON") from None
    if not isinstance(data, dict) or not isinstance(data.get("event"), str):
        raise ProtocolError("the line is no event")
    return data


def answers(request: str, prefix: str) -> str:
    """Return the channel of the responses to requests on a channel, to the clients of one process."""
    return f"{request.removesuffix('request')}response {prefix}"


def description(data: dict[str, Any]) -> Description:
    """Read a `description` event, dropping what is not of the right type."""
    return Description(
        nodes=tuple(_texts(data.get("nodes"))),
        timers=tuple(p for p in _items(data.get("timers")) if type(p) is int and p > 0),
        writers=tuple((channel, n) for channel, n in _pairs(data.get("writers"), str) if type(n) is int),
        readers=tuple(
            (tuple(_texts(channels)), n)
            for channels, n in _pairs(data.get("readers"), list)
            if n is None or type(n) is int
        ),
        clients=tuple((channel, ready is True) for channel, ready in _pairs(data.get("clients"), str)),
        servers=tuple(_texts(data.get("servers"))),
        early=_counts(data.get("early")),
        kept=_counts(data.get("kept")),
        prefix=_text(data.get("prefix")),
    )


def reply(data: dict[str, Any]) -> Reply:
    """Read a `done` event, dropping what is not of the right type."""
    wake = data.get("wake")
    return Reply(
        sent=_counts(data.get("sent")),
        lost=tuple(_texts(data.get("lost"))),
        changed=data.get("changed") is True,
        wake=wake if type(wake) is int else None,
        notes=tuple(reason for reason in _texts(data.get("notes")) if reason in REASONS),
    )


def reason(data: dict[str, Any]) -> str:
    """Read why a program cannot be stepped."""
    found = _text(data.get("reason"))
    return found if found in REASONS else "thread"


def deadlock(data: dict[str, Any]) -> Deadlock:
    """Read a `deadlock` event; texts are shortened to `MAX_TEXT`."""
    why = _text(data.get("reason"))
    return Deadlock(
        what=_text(data.get("what")), name=_text(data.get("name")), reason=why if why in ("group", "spin") else "thread"
    )


def crash(data: dict[str, Any]) -> Crash:
    """Read a `crash` event; texts are shortened to `MAX_TEXT`."""
    phase = data.get("phase")
    return Crash(
        phase=phase if phase in ("import", "start", "spin") else "start",
        type=_text(data.get("type")) or "Exception",
        message=_text(data.get("message")),
        traceback=_text(data.get("traceback")),
    )


def _items(value: object) -> list[Any]:
    return value[:MAX_TOPICS] if isinstance(value, list) else []


def _pairs(value: object, first: type) -> list[Any]:
    """Return the pairs in a list whose first item has the type `first`."""
    items = (item for item in _items(value) if isinstance(item, list) and len(item) == 2)
    return [item for item in items if isinstance(item[0], first)]


def _counts(value: object) -> dict[str, int]:
    counts = value if isinstance(value, dict) else {}
    return {topic: count for topic, count in list(counts.items())[:MAX_TOPICS] if type(count) is int and count >= 0}


def _texts(value: object) -> list[str]:
    return [_text(item) for item in _items(value) if isinstance(item, str)]


def _text(value: object) -> str:
    return value[-MAX_TEXT:] if isinstance(value, str) else ""
