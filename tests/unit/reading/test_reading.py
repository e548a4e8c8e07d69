"""Errors are attributed to the student's data, or pass through."""

from __future__ import annotations

import errno

import pytest

from autograder.diagnosis import Kind
from autograder.exceptions import GraderError, StudentError, UsageError
from autograder.submission.reading import clear_recorded_data, reading, record_data, recorded_data
from autograder.suite import CheckFailed


@pytest.mark.parametrize(
    "error",
    [
        LookupError("unknown encoding: foo"),
        OverflowError("int too large to convert to float"),
        RecursionError("too deep"),
        MemoryError(),
        RuntimeError("damaged"),
        AssertionError(),
        FileNotFoundError(errno.ENOENT, "No such file"),
        OSError(errno.ENAMETOOLONG, "File name too long"),
        UnicodeEncodeError("utf-8", "\ud800", 0, 1, "surrogates not allowed"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_error_while_data_are_read_is_the_student_s_and_names_them(error: Exception) -> None:
    with pytest.raises(StudentError) as excinfo, reading("src/robot/package.xml", advice="Write it again."):
        raise error
    diagnosis = excinfo.value.diagnosis
    assert diagnosis.kind is Kind.UNREADABLE
    assert diagnosis.sentence.startswith("src/robot/package.xml cannot be read: ")
    assert diagnosis.sentence.endswith(". Write it again.")
    assert excinfo.value.__cause__ is error


@pytest.mark.parametrize(
    "error",
    [
        GraderError("lost"),
        UsageError("no such file"),
        CheckFailed("wrong", fraction=0.5),
        OSError(errno.EMFILE, "Too many open files"),
        OSError(errno.EIO, "Input/output error"),
        KeyboardInterrupt(),
        SystemExit(1),
    ],
    ids=lambda error: type(error).__name__,
)
def test_attributed_errors_and_errors_of_the_machine_pass_through(error: BaseException) -> None:
    with pytest.raises(type(error)) as excinfo, reading("package.xml"):
        raise error
    assert excinfo.value is error


def test_the_reason_is_one_short_line_of_harmless_text() -> None:
    with pytest.raises(StudentError) as excinfo, reading("config.yaml"):
        raise ValueError("a\n\x1b]0;title\x07b\u202e" + "x" * 1000)
    sentence = excinfo.value.diagnosis.sentence
    assert len(sentence) < 300
    assert sentence.startswith("config.yaml cannot be read: a b\ufffdxxx")


def test_data_stay_attributed_until_they_are_released() -> None:
    clear_recorded_data()
    with reading("a.yaml"):
        pass
    record_data("b.yaml")
    record_data("a.yaml")
    assert recorded_data() == ("b.yaml", "a.yaml")
    clear_recorded_data()
    assert recorded_data() == ()
