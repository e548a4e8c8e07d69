"""Assigns errors: an error while the student's data is read, converted or compared is the student's.

Each door, a place where such data enters the trusted process, is a block::

    with reading("src/wheels/package.xml"):
        root = ET.fromstring(data)

An exception in the block becomes a `StudentError` that names the data. The grader's own errors with a message pass
through, and so do errors that only a machine can cause. A door also records the data's name. If a check itself raises
an exception, the check fails if any data was recorded, and otherwise it is a failure of the grader.
"""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import AutograderError, StudentError
from autograder.plain_text import clean

MAX_REASON = 200  # characters of an exception's text
MAX_INT = 10**100  # an int beyond a float's range can be neither compared with one nor, at 4,300 digits, shown
MAX_DEPTH = 20  # of lists in lists
MAX_VALUES = 100_000
# No data causes these: a failing disk, and a machine without free processes, memory or descriptors.
_OF_THE_MACHINE = frozenset(
    {errno.EIO, errno.EMFILE, errno.ENFILE, errno.EROFS, errno.ESTALE, errno.ENODEV, errno.EAGAIN, errno.ENOMEM}
)
# Errors of Python, its parsers and the fields of ROS messages for unexpected data.
_OF_DATA = (
    *(ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError, RecursionError, SyntaxError),
    *(TypeError, ValueError),
)
# Errors for files of an unexpected kind, name or size. shutil's own errors have no number.
_OF_FILES = frozenset(
    {errno.ENOENT, errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ENOTEMPTY, errno.ENAMETOOLONG, errno.ELOOP}
    | {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EINVAL, None}
)

_in_hand: dict[str, None] = {}  # names of data, each once, the latest last


@contextmanager
def reading(what: str, kind: Kind = Kind.UNREADABLE, advice: str = "") -> Iterator[None]:
    """Attribute errors in this block to the student, and record that the data was read.

    Args:
        what: the name of the data for the student, at the start of a sentence.
        kind: of the diagnosis.
        advice: a sentence with a fix.

    Raises:
        StudentError: the block raised an error that is neither the grader's own nor the machine's.
    """
    hold(what)
    try:
        yield
    except AutograderError:
        raise
    except Exception as error:
        if is_of_the_machine(error):
            raise
        sentence = f"{what} cannot be read: {reason(error)}."
        raise StudentError(Diagnosis(kind, f"{sentence} {advice}".strip())) from error


def hold(what: str) -> None:
    """Record that the student's data was read, by a name for the student."""
    _in_hand.pop(what, None)
    _in_hand[what] = None


def in_hand() -> tuple[str, ...]:
    """Return the names of the recorded data, the latest last."""
    return tuple(_in_hand)


def put_down() -> None:
    """Forget the recorded data before code that has not seen it."""
    _in_hand.clear()


def is_of_the_machine(error: BaseException) -> bool:
    """Return whether an exception is one that no data cause."""
    return isinstance(error, OSError) and error.errno in _OF_THE_MACHINE


def is_of_data(error: BaseException) -> bool:
    """Return whether an exception is one that code raises for data that it was not written for."""
    return isinstance(error, _OF_DATA) or (isinstance(error, OSError) and error.errno in _OF_FILES)


def beyond_bounds(value: object) -> str:
    """Return the type of a value that no check can compute with or show, or an empty string."""
    pending, count = [(value, 0)], 0
    while pending:
        each, depth = pending.pop()
        count += 1
        if count > MAX_VALUES:
            return f"{type(value).__name__} of more than {MAX_VALUES} values"
        if isinstance(each, int) and abs(each) > MAX_INT:
            return f"int above {float(MAX_INT):.0e}"
        if isinstance(each, list | tuple | dict):
            if depth == MAX_DEPTH:
                return f"{type(each).__name__} nested more than {MAX_DEPTH} deep"
            inside = (*each, *each.values()) if isinstance(each, dict) else each
            pending += [(inner, depth + 1) for inner in inside]
    return ""


def reason(error: BaseException) -> str:
    """Return an exception as one short line without control characters; without a text, the name of its class."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)  # without the path here
    words = " ".join(clean(text).split())
    return words[:MAX_REASON].rstrip(".") if words else type(error).__name__
