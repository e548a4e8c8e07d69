"""Each door by which data of a student's enter the worker: whatever comes is read, or is the student's fault.

`make test` tries a hundred made-up readings of each door, the same in each run. To try a thousand others, run
`pytest tests/unit/reading --hypothesis-profile=thousand`.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from autograder.exceptions import StudentError
from autograder.suite import CheckFailed
from tests.unit.reading.door import Door
from tests.unit.reading.doors import DOORS

# How a door says that the data are at fault; `doors` has those that the door's only caller turns into one of these.
THEIRS = (StudentError, CheckFailed)


@pytest.mark.fuzz
@pytest.mark.parametrize("door", DOORS.values(), ids=DOORS.keys())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large])
@given(data=st.data())
def test_generated_data_are_read_or_are_the_student_s_fault(door: Door, data: st.DataObject, tmp_path: Path) -> None:
    _read(door, data.draw(door.made_up), tmp_path)


@pytest.mark.parametrize(
    ("door", "known"),
    [pytest.param(door, known, id=f"{name}-{i}") for name, door in DOORS.items() for i, known in enumerate(door.known)],
)
def test_data_that_once_went_wrong_are_read_or_are_the_student_s_fault(door: Door, known: Any, tmp_path: Path) -> None:
    _read(door, known, tmp_path)


def _read(door: Door, value: Any, place: Path) -> None:
    with suppress(*THEIRS, *door.refuses):
        door.read(value, place)
