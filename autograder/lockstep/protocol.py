"""What the stepper and the host tell each other: a JSON object a line, over two inherited pipes.

    stepper -> host   {"op": "describe"}
                      {"op": "step", "t": NANOSECONDS, "sent": {TOPIC: MESSAGES SO FAR}}
                      {"op": "quit"}
    host -> stepper   {"event": "ready"}                  once, when the node first waits for work
                      {"event": "description", ...}
                      {"event": "done", "published": {TOPIC: MESSAGES SO FAR}, "late": BOOL}
                      {"event": "crash", "phase": ..., "type": ..., "message": ..., "traceback": ...}

The host shares a process with the student's code, which may forge any of it. So whatever comes from the host is
bounded in size, parsed into these records and used only to wait less, or to explain; no point depends on it.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

START = 100 * 10**9  # ns of ROS time at which a program starts; 0 would mean "time is not known yet"
MAX_LINE = 64 * 1024
MAX_TEXT = 8 * 1024
MAX_TOPICS = 256


class ProtocolError(Exception):
    """The host's line is no message of this protocol."""


@dataclass(frozen=True)
class Description:
    """What the host sees of the student's nodes.

    Attributes:
        nodes: fully qualified names.
        timers: periods in nanoseconds.
        unmatched: topics of the student's own publishers and subscriptions that have no peer yet.
        subscriptions: how many subscriptions there are, by topic.
    """

    nodes: tuple[str, ...]
    timers: tuple[int, ...]
    unmatched: tuple[str, ...]
    subscriptions: dict[str, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Reply:
    """A finished step.

    Attributes:
        published: how many messages the nodes have published so far, by topic.
        late: True when the nodes gave up waiting for messages that they were told of.
    """

    published: dict[str, int] = field(default_factory=dict)
    late: bool = False


@dataclass(frozen=True)
class Crash:
    """The exception that ended the student's program; `phase` is import, start or spin."""

    phase: str
    type: str
    message: str
    traceback: str


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


def description(data: dict[str, Any]) -> Description:
    """Read a `description` event, dropping what is not of the right type."""
    return Description(
        nodes=tuple(_texts(data.get("nodes"))),
        timers=tuple(p for p in _items(data.get("timers")) if type(p) is int and p > 0),
        unmatched=tuple(_texts(data.get("unmatched"))),
        subscriptions=_counts(data.get("subscriptions")),
    )


def reply(data: dict[str, Any]) -> Reply:
    """Read a `done` event, dropping what is not of the right type."""
    return Reply(published=_counts(data.get("published")), late=data.get("late") is True)


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


def _counts(value: object) -> dict[str, int]:
    counts = value if isinstance(value, dict) else {}
    return {topic: count for topic, count in list(counts.items())[:MAX_TOPICS] if type(count) is int and count >= 0}


def _texts(value: object) -> list[str]:
    return [_text(item) for item in _items(value) if isinstance(item, str)]


def _text(value: object) -> str:
    return value[-MAX_TEXT:] if isinstance(value, str) else ""
