"""Whose fault an error is: what fails while data of the student's are read, converted or compared is the student's.

Each door, a place where such data enter the trusted process, is a block::

    with reading("src/wheels/package.xml"):
        root = ET.fromstring(data)

Whatever the block raises becomes a `StudentError` that names the data. Errors of the grader that say what they are pass
through, and so does what only a machine can do. A door also notes what is in hand from then on: a check that raises an
exception of its own fails if it has something in hand, and is a failure of the grader if it has nothing.
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
# No data cause these: a disk that fails, and a machine that has no more processes, memory or descriptors.
_OF_THE_MACHINE = frozenset(
    {errno.EIO, errno.EMFILE, errno.ENFILE, errno.EROFS, errno.ESTALE, errno.ENODEV, errno.EAGAIN, errno.ENOMEM}
)
# What Python, its parsers and the fields of ROS messages raise for data that code was not written for.
_OF_DATA = (
    *(ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError, RecursionError, SyntaxError),
    *(TypeError, ValueError),
)
# What files of an unexpected kind, name or size cause; shutil's own errors have no number.
_OF_FILES = frozenset(
    {errno.ENOENT, errno.EEXIST, errno.ENOTDIR, errno.EISDIR, errno.ENOTEMPTY, errno.ENAMETOOLONG, errno.ELOOP}
    | {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EINVAL, None}
)

_in_hand: dict[str, None] = {}  # names of data, each once, the latest last


@contextmanager
def reading(what: str, kind: Kind = Kind.UNREADABLE, advice: str = "") -> Iterator[None]:
    """Make what fails in this block the student's fault, and note that the data are in hand.

    Args:
        what: names the data for the student, at the start of a sentence.
        kind: of the diagnosis.
        advice: a sentence that says what to do.

    Raises:
        StudentError: the block raised anything but an error of the grader's own or of the machine.
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
    """Note that data of the student's are in hand, by a name for the student."""
    _in_hand.pop(what, None)
    _in_hand[what] = None


def in_hand() -> tuple[str, ...]:
    """Return the names of the data in hand, the latest last."""
    return tuple(_in_hand)


def put_down() -> None:
    """Forget what is in hand: what comes now has not seen it."""
    _in_hand.clear()


def is_of_the_machine(error: BaseException) -> bool:
    """Return whether an exception is one that no data cause."""
    return isinstance(error, OSError) and error.errno in _OF_THE_MACHINE


def is_of_data(error: BaseException) -> bool:
    """Return whether an exception is one that code raises for data that it was not written for."""
    return isinstance(error, _OF_DATA) or (isinstance(error, OSError) and error.errno in _OF_FILES)


def beyond_bounds(value: object) -> str:
    """Return what in plain data no check can compute with or show, as the name of a type; empty if there is nothing."""
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
