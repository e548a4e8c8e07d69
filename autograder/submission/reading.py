"""Attributes errors to the student if they occur while the student's data is read, converted or compared.

In the trusted process, code that reads such data belongs in a block::

    with reading("src/wheels/package.xml"):
        root = ET.fromstring(data)

An exception in the block becomes a `StudentError` that names the data. `AutograderError` passes through, and so do
errors that only a machine can cause. The block also records the data's name. If a check itself raises an exception,
the check fails if any data was recorded. Otherwise the grader has failed.
"""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import AutograderError, StudentError
from autograder.plain_text import clean

MAX_REASON = 200  # characters of an exception's text
MAX_INT = 10**100  # a larger int overflows a float, or has too many digits to print
MAX_DEPTH = 20  # levels of nested lists, tuples and dictionaries
MAX_VALUES = 100_000
# Errors that no data can cause: a failing disk, a machine without free processes, memory or descriptors.
_MACHINE_ERRNOS = frozenset(
    {errno.EIO, errno.EMFILE, errno.ENFILE, errno.EROFS, errno.ESTALE, errno.ENODEV, errno.EAGAIN, errno.ENOMEM}
)
# Errors that Python, its parsers and the fields of ROS messages raise for unexpected data.
_DATA_ERRORS = (
    *(ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError, RecursionError, SyntaxError),
    *(TypeError, ValueError),
)
# Errors for files of an unexpected kind, name or size. shutil's own errors have no number.
_FILE_ERRNOS = frozenset(
    {errno.ENOENT, errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ENOTEMPTY, errno.ENAMETOOLONG, errno.ELOOP}
    | {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EINVAL, None}
)

_recorded_names: dict[str, None] = {}  # keys: the names of the data, the latest last


@contextmanager
def reading(label: str, kind: Kind = Kind.UNREADABLE, advice: str = "") -> Iterator[None]:
    """Attribute errors in this block to the student, and record that the data was read.

    Args:
        label: the name of the data for the student, at the start of a sentence.
        kind: the kind of the diagnosis.
        advice: a sentence with a fix.

    Raises:
        StudentError: the block raised an error that is neither the grader's own nor the machine's.
    """
    record_data(label)
    try:
        yield
    except AutograderError:
        raise
    except Exception as error:
        if is_machine_error(error):
            raise
        sentence = f"{label} cannot be read: {reason(error)}."
        raise StudentError(Diagnosis(kind, f"{sentence} {advice}".strip())) from error


def record_data(label: str) -> None:
    """Record that the student's data was read, under a name that the student understands."""
    _recorded_names.pop(label, None)
    _recorded_names[label] = None


def recorded_data() -> tuple[str, ...]:
    """Return the names of the recorded data, the latest last."""
    return tuple(_recorded_names)


def clear_recorded_data() -> None:
    """Clear the record, so that it will contain only the data that later code reads."""
    _recorded_names.clear()


def is_machine_error(error: BaseException) -> bool:
    """Return whether only the machine, and never the data, can have caused an exception."""
    return isinstance(error, OSError) and error.errno in _MACHINE_ERRNOS


def is_data_error(error: BaseException) -> bool:
    """Return whether an exception is typical of code that receives unexpected data."""
    return isinstance(error, _DATA_ERRORS) or (isinstance(error, OSError) and error.errno in _FILE_ERRNOS)


def beyond_bounds(value: object) -> str:
    """Return a description of a value that is too large to compute with or to show, or an empty string."""
    pending, count = [(value, 0)], 0
    while pending:
        item, depth = pending.pop()
        count += 1
        if count > MAX_VALUES:
            return f"{type(value).__name__} of more than {MAX_VALUES} values"
        if isinstance(item, int) and abs(item) > MAX_INT:
            return f"int above {float(MAX_INT):.0e}"
        if isinstance(item, list | tuple | dict):
            if depth == MAX_DEPTH:
                return f"{type(item).__name__} nested more than {MAX_DEPTH} deep"
            items = (*item, *item.values()) if isinstance(item, dict) else item
            pending += [(inner, depth + 1) for inner in items]
    return ""


def reason(error: BaseException) -> str:
    """Return the message of an exception as one short line, or the name of its class if it has no message."""
    # Unlike the text of an OSError, strerror does not contain the path.
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    words = " ".join(clean(text).split())
    return words[:MAX_REASON].rstrip(".") if words else type(error).__name__
