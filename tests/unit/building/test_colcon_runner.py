"""Each print of colcon is one write: its other thread logs to the same terminal."""

from __future__ import annotations

import io
from typing import Any

import pytest

from autograder.building.colcon_runner import print_in_one_write


class Recorder(io.StringIO):
    """A stream that remembers each call of `write` and `flush`."""

    def __init__(self) -> None:
        super().__init__()
        self.calls: list[str | None] = []

    def write(self, text: str) -> int:
        self.calls.append(text)
        return len(text)

    def flush(self) -> None:
        self.calls.append(None)


@pytest.mark.parametrize(
    ("values", "options", "text"),
    [
        (("Starting >>> pkg",), {}, "Starting >>> pkg\n"),
        (("--- stderr: pkg\nerror\n---",), {}, "--- stderr: pkg\nerror\n---\n"),
        (("a", 1, None), {}, "a 1 None\n"),
        (("a", "b"), {"sep": "", "end": ""}, "ab"),
        (("a", "b"), {"sep": None, "end": None}, "a b\n"),
        ((), {}, "\n"),
    ],
)
def test_a_line_and_its_end_are_written_together(values: tuple[Any, ...], options: dict[str, Any], text: str) -> None:
    stream, printed = Recorder(), io.StringIO()
    print(*values, **options, file=printed)
    print_in_one_write(*values, **options, file=stream, flush=True)
    assert stream.calls == [text, None]
    assert printed.getvalue() == text


def test_standard_output_is_the_default(capsys: pytest.CaptureFixture[str]) -> None:
    print_in_one_write("a line")
    assert capsys.readouterr().out == "a line\n"
