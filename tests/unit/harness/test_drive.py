"""A drive reads the output of programs, line by line, at the step in which they write it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

import pytest

from autograder.harness import Harness, drive
from sim import RobotSpec, Simulation, World, box

WORLD = Simulation(World.from_segments(box(4.0, 3.0)), (RobotSpec(),))


class Program:
    """A process with its output."""

    def __init__(self, written: bytes) -> None:
        self.text = written

    def output_from(self, start: int) -> bytes:
        return self.text[start:]


class Talking:
    """A harness with one program, which writes the next piece of its output at each step."""

    tick_ns = 100_000_000

    def __init__(self, seconds: float, pieces: Sequence[bytes], before: bytes = b"") -> None:
        self.seconds, self._pieces = seconds, list(pieces)
        self.processes = (Program(before),)
        self.output = ""

    @property
    def now_ns(self) -> int:
        return round(self.seconds * 1e9)

    def publish(self, topic: str, message: Any) -> None:
        """Ignore the message, as the program does."""

    def messages(self, topic: str) -> list[Any]:
        return []

    def step(self, dt_ns: int) -> None:
        self.seconds += dt_ns / 1e9
        self.processes[0].text += self._pieces.pop(0) if self._pieces else b""


def recorded_lines(harness: Talking) -> tuple[tuple[float, str], ...]:
    return drive(cast("Harness", harness), WORLD, 0.5).recording.log_lines


def test_each_line_has_the_instant_of_its_line_end() -> None:
    pieces = [b"hello\nhalf", b"", b" a line\n\xff\n", b"no end"]
    assert recorded_lines(Talking(0.0, pieces, b"started\n")) == (
        (0.1, "started"),
        (0.1, "hello"),
        (0.3, "half a line"),
        (0.3, "\ufffd"),
    )


def test_output_written_before_the_drive_is_ignored() -> None:
    assert recorded_lines(Talking(7.0, [b"mine\n"], b"of another check\n")) == ((0.1, "mine"),)


@pytest.mark.parametrize(
    ("output", "text"),
    [
        (b"[WARN] [1764044043.123456789] [follower]: near", "[WARN] [follower]: near"),
        (b"\x1b[33m[WARN] [1764044043.1] [follower]: near\x1b[0m", "[WARN] [follower]: near"),
        (b"said at [12.5] [x]", "said at [12.5] [x]"),
        ("‮evil\x00".encode(), "\ufffdevil\ufffd"),
    ],
)
def test_a_line_is_shown_without_the_machines_time_and_without_terminal_codes(output: bytes, text: str) -> None:
    assert recorded_lines(Talking(0.0, [output + b"\n"])) == ((0.1, text),)
