"""Each reader of a student's data accepts any input, or raises an error that is the student's fault.

`make test` tries a hundred generated values for each reader, the same in each run. To try a thousand others, run
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
from tests.unit.reading.reader import Reader
from tests.unit.reading.readers import READERS

# Errors that blame the data. `Reader.refuses` has those that the reader's only caller turns into one of these.
THEIRS = (StudentError, CheckFailed)


@pytest.mark.fuzz
@pytest.mark.parametrize("reader", READERS.values(), ids=READERS.keys())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large])
@given(data=st.data())
def test_generated_data_are_read_or_are_the_student_s_fault(
    reader: Reader, data: st.DataObject, tmp_path: Path
) -> None:
    _read(reader, data.draw(reader.values), tmp_path)


@pytest.mark.parametrize(
    ("reader", "value"),
    [
        pytest.param(reader, value, id=f"{name}-{i}")
        for name, reader in READERS.items()
        for i, value in enumerate(reader.known)
    ],
)
def test_data_that_once_went_wrong_are_read_or_are_the_student_s_fault(
    reader: Reader, value: Any, tmp_path: Path
) -> None:
    _read(reader, value, tmp_path)


def _read(reader: Reader, value: Any, folder: Path) -> None:
    with suppress(*THEIRS, *reader.refuses):
        reader.read(value, folder)
