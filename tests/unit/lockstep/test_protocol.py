"""What the host says is bounded, and dropped where it is of the wrong type."""

from __future__ import annotations

import ast
import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.lockstep import protocol
from autograder.lockstep.protocol import MAX_LINE, MAX_TEXT, MAX_TOPICS, ProtocolError
from autograder.lockstep.stepper import HOST

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=10), inner, max_size=5),
    max_leaves=20,
)
FIELDS = st.sampled_from(
    [
        *("sent", "late", "changed", "wake", "nodes", "timers"),
        *("writers", "readers", "clients", "servers", "early", "kept"),
        *("prefix", "phase", "type", "message", "traceback"),
    ]
)


def _line(**event: Any) -> bytes:
    return json.dumps(event).encode() + b"\n"


def test_an_event_is_a_line_of_json() -> None:
    assert protocol.parse(_line(event="ready")) == {"event": "ready"}


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        (b"", "cut short"),
        (b'{"event": "ready"}', "cut short"),
        (b"x" * (MAX_LINE + 1) + b"\n", "too long"),
        (b"PASS 100/100\n", "no JSON"),
        (b'\xff\xfe{"event": 1}\n', "no JSON"),
        (b"[" * 30_000 + b"\n", "no JSON"),
        (b'{"event": ' + b"9" * 10_000 + b"}\n", "no JSON"),
        (b'["event"]\n', "no event"),
        (b'{"event": 1}\n', "no event"),
        (b"{}\n", "no event"),
    ],
)
def test_anything_else_is_refused(line: bytes, reason: str) -> None:
    with pytest.raises(ProtocolError, match=reason):
        protocol.parse(line)


@settings(deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_get_through_but_events(noise: bytes) -> None:
    try:
        event = protocol.parse(noise + b"\n")
    except ProtocolError:
        return
    assert isinstance(event["event"], str)


@pytest.mark.slow
@settings(deadline=None)
@given(st.dictionaries(FIELDS, JSON))
def test_forged_fields_of_any_type_become_records_of_the_right_one(forged: dict[str, Any]) -> None:
    reply = protocol.reply(forged)
    assert all(type(topic) is str and type(n) is int and n >= 0 for topic, n in reply.sent.items())
    assert all(type(channel) is str for channel in reply.lost)
    assert type(reply.changed) is bool
    description = protocol.description(forged)
    assert all(type(name) is str for name in (*description.nodes, *description.servers, *description.reads()))
    assert all(type(period) is int and period > 0 for period in description.timers)
    assert all(type(name) is str and type(n) is int for name, n in description.writers)
    assert all(n is None or type(n) is int for _, n in description.readers)
    assert all(type(name) is str and type(ready) is bool for name, ready in description.clients)
    assert all(type(n) is int and n >= 0 for n in (*description.early.values(), *description.kept.values()))
    assert type(description.prefix) is str
    crash = protocol.crash(forged)
    assert crash.phase in ("import", "start", "spin")
    assert all(type(text) is str for text in (crash.type, crash.message, crash.traceback))


def test_true_is_no_count() -> None:
    assert protocol.reply({"sent": {"/a": True, "/b": -1, "/c": 1.0, "/d": 2}}).sent == {"/d": 2}


def test_changed_is_true_and_nothing_like_it() -> None:
    assert [protocol.reply({"changed": value}).changed for value in (True, 1, "true", [0], None)] == [
        True,
        *[False] * 4,
    ]


def test_a_description_says_what_the_program_reads() -> None:
    description = protocol.description(
        {
            "readers": [[["/scan T reliable volatile", "/scan T best-effort volatile"], 1], [["/odom T"], None]],
            "servers": ["/add S request"],
            "clients": [["/ask S request", True]],
            "prefix": "0a1b",
        }
    )
    assert description.reads() == {
        "/scan T reliable volatile",
        "/scan T best-effort volatile",
        "/odom T",
        "/add S request",
        "/ask S response 0a1b",
    }


@pytest.mark.parametrize(("wake", "found"), [(5, 5), (True, None), (5.0, None), ("5", None), (None, None)])
def test_a_time_to_wake_is_a_whole_number(wake: object, found: int | None) -> None:
    assert protocol.reply({"wake": wake}).wake == found


def test_reasons_are_those_that_have_a_sentence() -> None:
    assert protocol.reply({"notes": ["clock", "give me points", 7, "thread"]}).notes == ("clock", "thread")
    assert protocol.reason({"reason": "sleep"}) == "sleep"
    assert protocol.reason({"reason": ["sleep"]}) == "thread"
    deadlock = protocol.deadlock({"what": "x" * 10 * MAX_TEXT, "name": 3, "reason": "luck"})
    assert (len(deadlock.what), deadlock.name, deadlock.reason) == (MAX_TEXT, "", "thread")


def test_texts_and_lists_are_cut() -> None:
    crash = protocol.crash({"type": "E", "message": "m" * 10 * MAX_TEXT, "traceback": "t" * 10 * MAX_TEXT})
    assert (len(crash.message), len(crash.traceback)) == (MAX_TEXT, MAX_TEXT)
    description = protocol.description({"nodes": ["/n"] * 10 * MAX_TOPICS, "timers": [1] * 10 * MAX_TOPICS})
    assert (len(description.nodes), len(description.timers)) == (MAX_TOPICS, MAX_TOPICS)
    assert len(protocol.reply({"sent": {str(n): n for n in range(10 * MAX_TOPICS)}}).sent) == MAX_TOPICS


def _trees() -> dict[str, ast.Module]:
    return {path.name: ast.parse(path.read_text()) for path in HOST.glob("*.py")}


def test_the_host_imports_nothing_of_the_grader() -> None:
    imported = {
        name.split(".")[0]
        for tree in _trees().values()
        for node in ast.walk(tree)
        for name in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    assert "rclpy" in imported
    assert not imported & {"autograder", "sim"}
