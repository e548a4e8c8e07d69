"""Limits the processor time and the memory of reading a submission.

The limits of sizes and counts come first, and a submission that keeps them is read in time. These limits are for what
they do not foresee: the student is told that the submission cannot be read, and the process that reads it continues.
"""

from __future__ import annotations

import resource
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError

MAX_SECONDS = 100.0  # of processor time; it takes a minute to unpack as much bzip2 as the limits allow
MAX_MEMORY = 2 * 1024 * 1024 * 1024  # bytes of virtual memory; a submission that keeps the limits takes less than half


class _OutOfTimeError(Exception):
    """The processor time is used up. No reader handles this error, unlike a StudentError about an inner archive."""


@contextmanager
def bounded() -> Iterator[None]:
    """Limit the processor time and the memory of the code in this block.

    The limits apply to the whole process, and a process that another thread starts would inherit them. So they are not
    set if there is another thread.

    Raises:
        StudentError: a limit was exceeded.
    """
    if threading.active_count() > 1 or threading.current_thread() is not threading.main_thread():
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limits = [limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY]
    previous_handler = signal.signal(signal.SIGPROF, _end)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (min([_virtual_memory() + MAX_MEMORY, *limits]), hard))
        signal.setitimer(signal.ITIMER_PROF, MAX_SECONDS)
        yield
    except _OutOfTimeError:
        raise _too_expensive(f"that takes more than {MAX_SECONDS:.0f} s") from None
    except MemoryError:
        raise _too_expensive(f"that takes more than {MAX_MEMORY // 2**30} GiB of memory") from None
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, previous_handler)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def _end(*_: object) -> None:
    raise _OutOfTimeError


def _virtual_memory() -> int:
    """Return the bytes of virtual memory that this process has."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def _too_expensive(reason: str) -> StudentError:
    sentence = f"Your submission cannot be read, because {reason}. Hand in only the notebook and ws/src."
    return StudentError(Diagnosis(Kind.UNREADABLE, sentence))
