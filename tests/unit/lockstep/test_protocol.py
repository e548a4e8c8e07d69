"""Messages of the host are bounded, and refused if they have the wrong type."""

from __future__ import annotations

import ast
import contextlib
import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.run.lockstep import protocol
from autograder.run.lockstep.protocol import MAX_LINE, MAX_TEXT, ProtocolError
from autograder.run.lockstep.stepper import HOST

DONE: dict[str, Any] = {
    **{"event": "done", "sent": [{}], "lost": [], "changed": False, "wake": None, "due": None, "notes": []}
}
CRASH: dict[str, Any] = {"event": "crash", "phase": "spin", "type": "E", "message": "m", "traceback": "t"}
DEADLOCK: dict[str, Any] = {"event": "deadlock", "what": "wait()", "name": "", "reason": "group"}
DESCRIPTION: dict[str, Any] = {
    **{"event": "description", "nodes": ["/n"], "timers": [10**8], "prefix": "0a1b", "early": {}, "kept": {}},
    "writers": [["/said T", 1]],
    "readers": [[["/scan T reliable volatile", "/scan T best-effort volatile"], 1], [["/odom T"], None]],
    "servers": ["/add S request"],
    "clients": [["/ask S request", True]],
}


def _line(**event: Any) -> bytes:
    return json.dumps(event).encode() + b"\n"


def test_an_event_is_a_line_of_json() -> None:
    assert protocol.parse(_line(event="ready")) == ("ready", None)
    assert protocol.parse(_line(**CRASH)) == ("crash", protocol.Crash("spin", "E", "m", "t"))
    assert protocol.parse(_line(event="unsteppable", reason="sleep")) == ("unsteppable", "sleep")


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        (b"", "cut short"),
        (b'{"event": "ready"}', "cut short"),
        (b"x" * (MAX_LINE + 1) + b"\n", "too long"),
        (b"PASS 100/100\n", "not a valid event"),
        (b'\xff\xfe{"event": 1}\n', "not a valid event"),
        (b"[" * 30_000 + b"\n", "not a valid event"),
        (b'{"event": ' + b"9" * 10_000 + b"}\n", "not a valid event"),
        (b'["event"]\n', "not a valid event"),
        (b'{"event": 1}\n', "not a valid event"),
        (b"{}\n", "not a valid event"),
        (b'{"event": "passed", "score": 100}\n', "not a valid event"),
    ],
)
def test_a_line_that_is_not_an_event_is_rejected(line: bytes, reason: str) -> None:
    with pytest.raises(ProtocolError, match=reason):
        protocol.parse(line)


@pytest.mark.fuzz
@given(st.binary(max_size=200))
def test_any_bytes_are_an_event_or_refused(noise: bytes) -> None:
    with contextlib.suppress(ProtocolError):
        assert protocol.parse(noise + b"\n")[0] in ("ready", "matched")


@pytest.mark.parametrize(
    ("event", "forged"),
    [
        *((DONE, {"sent": [counts]}) for counts in ({"/a": True}, {"/a": -1}, {"/a": 1.0}, ["/a"], None)),
        *((DONE, {"sent": sent}) for sent in ({"/a": 1}, 7, None)),
        *((DONE, {name: time}) for name in ("wake", "due") for time in (True, 5.0, "5")),
        *((DONE, {"notes": notes}) for notes in (["give me points"], [["thread"]], 7)),
        *((DONE, {"lost": lost}) for lost in ([7], 7)),
        (DONE, {"points": 100}),
        *((DESCRIPTION, {"writers": writers}) for writers in ([["/said T"]], [[7, 1]], [["/said T", "1"]], 7)),
        *((DESCRIPTION, {"readers": readers}) for readers in ([["/odom T", "x"]], [[[7], None]])),
        *((DESCRIPTION, {name: [7]}) for name in ("nodes", "servers", "clients")),
        (DESCRIPTION, {"timers": [-1]}),
        (DESCRIPTION, {"prefix": None}),
        *((CRASH, {"phase": phase}) for phase in ("end", ["spin"], None)),
        (CRASH, {"message": {"x": 1}}),
        (DEADLOCK, {"reason": "luck"}),
        ({"event": "unsteppable"}, {"reason": ["sleep"]}),
    ],
)
def test_an_event_with_a_field_of_another_type_is_refused(event: dict[str, Any], forged: dict[str, Any]) -> None:
    with pytest.raises(ProtocolError, match="not a valid event"):
        protocol.parse(_line(**{**event, **forged}))


def test_changed_accepts_only_true() -> None:
    parsed = [protocol.parse(_line(**{**DONE, "changed": value}))[1].changed for value in (True, 1, "true", [0], None)]
    assert parsed == [True, *[False] * 4]


def test_a_description_says_what_the_program_reads() -> None:
    _, description = protocol.parse(_line(**DESCRIPTION))
    assert description.timers == (10**8,)
    assert description.reads == {
        "/scan T reliable volatile",
        "/scan T best-effort volatile",
        "/odom T",
        "/add S request",
        "/ask S response 0a1b",
    }


def test_long_texts_of_an_event_are_cut() -> None:
    _, crash = protocol.parse(_line(**{**CRASH, "message": "m" * 3 * MAX_TEXT, "traceback": "t" * 3 * MAX_TEXT}))
    assert (len(crash.message), len(crash.traceback)) == (MAX_TEXT, MAX_TEXT)


def _trees() -> dict[str, ast.Module]:
    return {path.name: ast.parse(path.read_text()) for path in HOST.glob("*.py")}


def test_the_host_imports_nothing_from_the_grader() -> None:
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
