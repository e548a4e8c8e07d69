"""Which processes of a launch are meant: by their action, by a part of their name, by their arguments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from launch.actions import ExecuteLocal
from launch.substitutions import TextSubstitution

NO_CMD_ARGS = object()  # for a process that was started without arguments


class NoMatchingProcessException(Exception):  # the real one's name
    """None of the recorded processes is meant."""


class Recorded(Protocol):
    """What knows processes: a handler of their output, or of their ends."""

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions of the processes."""


def resolveProcesses(
    info_obj: Recorded,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: str | Sequence[str] | object | None = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteLocal]:
    """Return the processes that are meant.

    Args:
        info_obj: what was recorded.
        process: the action of a process, a part of a name, or None for all processes.
        cmd_args: with a name: an argument, or several, that the process was started with, or NO_CMD_ARGS.
        strict_proc_matching: a name may not mean several processes.

    Raises:
        NoMatchingProcessException: there is no such process.
        Exception: the name means several processes.
        TypeError: `process` is something else.
    """
    recorded = list(info_obj.processes())
    if process is None:
        if not recorded:
            raise NoMatchingProcessException("No data recorded for any process")
        return recorded
    if isinstance(process, ExecuteLocal):
        if process not in recorded:
            raise NoMatchingProcessException(f"No data recorded for proc {_described(process)}")
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"proc argument must be 'ExecuteProcess' or 'str' not {type(process)}")
    arguments: Any = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    found = [one for one in recorded if process in _details(one)["name"] and _started_with(one, arguments)]
    if not found or (strict_proc_matching and len(found) > 1):
        names = ", ".join(sorted(map(_described, recorded)))
        if not found:
            raise NoMatchingProcessException(
                f"Did not find any processes matching name '{process}' and args '{arguments}'. Procs: {names}"
            )
        raise Exception(
            f"Found multiple processes matching name '{process}' and cmd_args '{arguments}'. Procs: {names}"
        )
    return found


def _details(process: ExecuteLocal) -> dict[str, Any]:
    assert process.process_details is not None  # it was recorded, so it was prepared
    return process.process_details


def _started_with(process: ExecuteLocal, arguments: Any) -> bool:
    given = _details(process)["cmd"][1:]
    if arguments is NO_CMD_ARGS:
        return not given
    return arguments is None or all(argument in given for argument in arguments)


def _described(process: ExecuteLocal) -> str:
    if process.process_details is None:
        command = process.process_description.cmd
        texts = [[part.text for part in word if isinstance(part, TextSubstitution)] for word in command]
        known = all(len(text) == len(word) for text, word in zip(texts, command, strict=True))
        return " ".join("".join(text) for text in texts) if known else "Unknown - Process not launched yet"
    return " ".join([process.process_details["name"], *process.process_details["cmd"][1:]])
