"""A time record collects which programs ran in real time, and writes the note of the result."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from autograder.ros import environment
from autograder.run.time_record import LOCKSTEP, REAL, TimeRecord
from autograder.run.workspace import Workspace


@pytest.mark.parametrize(
    ("reasons", "sentence"),
    [
        (
            {"a": "thread"},
            "a ran in real time, because it uses rclpy in threads of its own. "
            "Programs that run alongside it also ran in real time: b.",
        ),
        (
            {"a": REAL, "b": REAL},
            "a ran in real time, because this was requested. b ran in real time, because this was requested.",
        ),
    ],
    ids=["one cannot be stepped", "asked for"],
)
def test_programs_in_real_time_are_named_with_the_reason(reasons: dict[str, str], sentence: str) -> None:
    record = TimeRecord()
    assert (record.time, record.explain()) == (LOCKSTEP, "")
    record.add_real_time(["a", "b"], reasons)
    assert (record.time, record.explain()) == (REAL, sentence)


def test_a_reason_is_kept_if_the_program_later_runs_with_another_one() -> None:
    record = TimeRecord()
    record.add_real_time(["a"], {"a": "sleep"})
    record.add_real_time(["a", "b"], {"b": "clock"})
    assert record.real_time == {"a": "sleep", "b": "clock"}


def test_the_longest_wait_is_kept() -> None:
    record = TimeRecord()
    for seconds in (-0.1, 0.2, 0.5, 0.3):
        record.add_wait(seconds)
    assert record.longest_wait == 0.5


def test_copies_of_a_workspace_share_its_record_and_other_workspaces_do_not(tmp_path: Path) -> None:
    first, second = (Workspace(tmp_path, environment.find(), tmp_path) for _ in range(2))
    assert replace(first, domain=7).time_record is first.time_record
    assert first.time_record is not second.time_record
    assert first == second
