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
    """Fail unless each matching process (see `resolveProcesses`) has ended with an allowed exit code."""
    for code in allowable_exit_codes:
        assert isinstance(code, int), f"Provided exit code {code} is not an int"
    processes = resolveProcesses(
        proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    )
    for event in [proc_info[action] for action in processes]:
        if not isinstance(event, ProcessExited):  # the process is still running
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
    """Fail unless a text is in the output of one of the matching processes (see `resolveProcesses`).

    Args:
        proc_output: the output of the processes.
        expected_output: a text, a compiled regular expression, or a list of them, which must come in this order.
        process: the action of a process, a part of its name, or None for all processes.
        cmd_args: with a name, one or several arguments of the process, or NO_CMD_ARGS.
        output_filter: a function that is applied to the output first.
        strict_proc_matching: whether a name must match only one process.
        strip_ansi_escape_sequences: whether to remove colours from the output first.
        stream: "stdout" or "stderr".

    Raises:
        ValueError: the stream, the filter or the expected output is invalid.
    """
    processes = resolveProcesses(
        proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    )
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    if stream not in ("stdout", "stderr"):
        raise ValueError("Invalid value for stream; must be 'stdout' or 'stderr'")
    for action in processes:
        text = "".join(event.text.decode() for event in proc_output[action] if getattr(event, f"from_{stream}"))
        if strip_ansi_escape_sequences:
            text = _ESCAPE.sub("", text)
        if _contains(output_filter(text) if output_filter else text, expected_output):
            return
    names = ", ".join(sorted((action.process_details or {})["name"] for action in processes))
    raise AssertionError(f"Did not find '{expected_output}' in output for any of the matching processes: {names}")


def _contains(text: str, expected: Any) -> bool:
    """Return whether a text contains the expected output; the parts of a list are on separate lines, in order."""
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
    """Return the default stream of `assertInStream`."""
    return "stderr"


class SequentialTextChecker:
    """Finds texts in pieces of output, each after the last one."""

    def __init__(self, output: Sequence[str]) -> None:
        self._pieces = output
        self._index = 0
        self._position = 0

    def assertInText(self, msg: str) -> None:
        """Fail unless the text comes after the last one, within one piece."""
        position = self._position
        for index in range(self._index, len(self._pieces)):
            match_start = self._pieces[index].find(msg, position)
            if match_start >= 0:
                self._index, self._position = index, match_start + len(msg)
                return
            position = 0
        raise AssertionError(
            f"'{msg}' not found in sequence after previous match.  "
            f"The output near the last matched line:\n{self.get_nearby_lines()}"
        )

    assertInStdout = assertInText

    def get_nearby_lines(self) -> str:
        """Return some lines before and after the last match."""
        text, position = "".join(self._pieces), len("".join(self._pieces[: self._index])) + self._position
        before, after = text[:position], text[position:]
        lines = "\n".join(before.split("\n")[-3:]) + "\n".join(after.split("\n")[:3])
        return lines.rstrip("\n")


@contextmanager
def assertSequentialStdout(
    proc_output: IoHandler, process: ExecuteLocal | str, cmd_args: Any = None
) -> Iterator[SequentialTextChecker]:
    """Return a checker for the order of the texts that a process wrote."""
    (action,) = resolveProcesses(proc_output, process=process, cmd_args=cmd_args)
    yield SequentialTextChecker([event.text.decode() for event in proc_output[action]])


__getattr__ = make_getattr(__name__)
