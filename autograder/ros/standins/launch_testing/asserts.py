"""Assertions about the output and the exit codes of processes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from launch.actions import ExecuteLocal
from launch.events.process import ProcessExited
from standin_notice import make_getattr

from .util import NO_CMD_ARGS, resolveProcesses

if TYPE_CHECKING:
    from .io_handler import IoHandler
    from .proc_info_handler import ProcInfoHandler

__all__ = [
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "NO_CMD_ARGS",
    "SequentialTextChecker",
    "assertDefaultStream",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertInStream",
    "assertSequentialStdout",
]

EXIT_OK = 0
EXIT_SIGINT = 130
EXIT_SIGQUIT = 131
EXIT_SIGKILL = 137
EXIT_SIGSEGV = 139

_ESCAPE = re.compile(r"\x1b\[[0-9;]*m")


def assertExitCodes(
    proc_info: ProcInfoHandler,
    allowable_exit_codes: Sequence[int] = (EXIT_OK,),
    process: ExecuteLocal | str | None = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Fail unless each process that is meant (see `resolveProcesses`) has ended with an allowed exit code."""
    for code in allowable_exit_codes:
        assert isinstance(code, int), f"Provided exit code {code} is not an int"
    meant = resolveProcesses(proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    for event in [proc_info[one] for one in meant]:
        if not isinstance(event, ProcessExited):  # it was started, and has not ended
            raise AttributeError(f"'{type(event).__name__}' object has no attribute 'returncode'")
        code = event.returncode
        assert code in allowable_exit_codes, f"Proc {event.process_name} exited with code {code}"


def assertInStream(
    proc_output: IoHandler,
    expected_output: Any,
    process: ExecuteLocal | str | None,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Fail unless a text is in the output of one of the processes that are meant (see `resolveProcesses`).

    Args:
        proc_output: the output of the processes.
        expected_output: a text, a compiled regular expression that is searched for, or a list of them, in this order.
        process: the action of a process, a part of a name, or None for all processes.
        cmd_args: with a name: an argument, or several, that the process was started with, or NO_CMD_ARGS.
        output_filter: applied to the output first.
        strict_proc_matching: a name may not mean several processes.
        strip_ansi_escape_sequences: take colours out of the output first.
        stream: "stdout" or "stderr".

    Raises:
        ValueError: the stream, the filter or the expected output is none.
    """
    meant = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    if stream not in ("stdout", "stderr"):
        raise ValueError("Invalid value for stream; must be 'stdout' or 'stderr'")
    for one in meant:
        text = "".join(event.text.decode() for event in proc_output[one] if getattr(event, f"from_{stream}"))
        if strip_ansi_escape_sequences:
            text = _ESCAPE.sub("", text)
        if _holds(output_filter(text) if output_filter else text, expected_output):
            return
    names = ", ".join(sorted((one.process_details or {})["name"] for one in meant))
    raise AssertionError(f"Did not find '{expected_output}' in output for any of the matching processes: {names}")


def _holds(text: str, expected: Any) -> bool:
    """Return whether a text holds what is expected, the parts of a list on lines of their own, in this order."""
    if isinstance(expected, str):
        return expected in text
    if isinstance(expected, re.Pattern):
        return expected.search(text) is not None
    if not isinstance(expected, (list, tuple)):
        raise ValueError("Unknown format for expected text")
    lines = iter(text.replace("\r\n", "\n").splitlines())
    return all(
        any(part.match(line) if isinstance(part, re.Pattern) else part in line for line in lines) for part in expected
    )


def assertInStdout(proc_output: IoHandler, *args: Any, **kwargs: Any) -> None:
    """Fail unless a text is in the standard output; see `assertInStream`."""
    assertInStream(proc_output, *args, **kwargs, stream="stdout")


def assertInStderr(proc_output: IoHandler, *args: Any, **kwargs: Any) -> None:
    """Fail unless a text is in the standard error; see `assertInStream`."""
    assertInStream(proc_output, *args, **kwargs, stream="stderr")


def assertDefaultStream() -> str:
    """Return the stream that `assertInStream` looks at if it is not told."""
    return "stderr"


class SequentialTextChecker:
    """Finds texts in pieces of output, each behind the last one."""

    def __init__(self, output: Sequence[str]) -> None:
        self._pieces = output
        self._piece = 0
        self._place = 0

    def assertInText(self, msg: str) -> None:
        """Fail unless the text comes behind the last one, in one piece."""
        place = self._place
        for number in range(self._piece, len(self._pieces)):
            found = self._pieces[number].find(msg, place)
            if found >= 0:
                self._piece, self._place = number, found + len(msg)
                return
            place = 0
        raise AssertionError(
            f"'{msg}' not found in sequence after previous match.  "
            f"The output near the last matched line:\n{self.get_nearby_lines()}"
        )

    assertInStdout = assertInText

    def get_nearby_lines(self) -> str:
        """Return some lines before and after the last match."""
        text, place = "".join(self._pieces), len("".join(self._pieces[: self._piece])) + self._place
        matched, following = text[:place], text[place:]
        near = "\n".join(matched.split("\n")[-3:]) + "\n".join(following.split("\n")[:3])
        return near.rstrip("\n")


@contextmanager
def assertSequentialStdout(
    proc_output: IoHandler, process: ExecuteLocal | str, cmd_args: Any = None
) -> Iterator[SequentialTextChecker]:
    """Give a checker of the order in which a process wrote texts."""
    (meant,) = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)
    yield SequentialTextChecker([event.text.decode() for event in proc_output[meant]])


__getattr__ = make_getattr(__name__)
