"""The search for processes of a launch, by their action, a part of their name, or their arguments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

from launch.actions import ExecuteLocal
from launch.substitutions import TextSubstitution

NO_CMD_ARGS = object()  # matches a process without arguments


class NoMatchingProcessException(Exception):  # the name in the real package
    """No recorded process matches."""


class ProcessRecord(Protocol):
    """A record of processes: a handler of their output, or of their exits."""

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions of the processes."""


def resolveProcesses(
    info_obj: ProcessRecord,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: str | Sequence[str] | object | None = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteLocal]:
    """Return the matching processes.

    Args:
        info_obj: the record of processes.
        process: the action of a process, a part of its name, or None for all processes.
        cmd_args: with a name, one or several arguments of the process, or NO_CMD_ARGS.
        strict_proc_matching: whether a name must match only one process.

    Raises:
        NoMatchingProcessException: there is no such process.
        Exception: the name matches several processes.
        TypeError: `process` has another type.
    """
    recorded = list(info_obj.processes())
    if process is None:
        if not recorded:
            raise NoMatchingProcessException("No data recorded for any process")
        return recorded
    if isinstance(process, ExecuteLocal):
        if process not in recorded:
            raise NoMatchingProcessException(f"No data recorded for proc {_describe(process)}")
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"proc argument must be 'ExecuteProcess' or 'str' not {type(process)}")
    arguments: Any = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    matches = [
        action for action in recorded if process in _details(action)["name"] and _has_arguments(action, arguments)
    ]
    if not matches or (strict_proc_matching and len(matches) > 1):
        names = ", ".join(sorted(map(_describe, recorded)))
        if not matches:
            raise NoMatchingProcessException(
                f"Did not find any processes matching name '{process}' and args '{arguments}'. Procs: {names}"
            )
        raise Exception(
            f"Found multiple processes matching name '{process}' and cmd_args '{arguments}'. Procs: {names}"
        )
    return matches


def _details(process: ExecuteLocal) -> dict[str, Any]:
    assert process.process_details is not None  # a recorded process was prepared
    return process.process_details


def _has_arguments(process: ExecuteLocal, arguments: Any) -> bool:
    process_arguments = _details(process)["cmd"][1:]
    if arguments is NO_CMD_ARGS:
        return not process_arguments
    return arguments is None or all(argument in process_arguments for argument in arguments)


def _describe(process: ExecuteLocal) -> str:
    if process.process_details is None:
        command = process.process_description.cmd
        texts = [[part.text for part in word if isinstance(part, TextSubstitution)] for word in command]
        is_known = all(len(text) == len(word) for text, word in zip(texts, command, strict=True))
        return " ".join("".join(text) for text in texts) if is_known else "Unknown - Process not launched yet"
    return " ".join([process.process_details["name"], *process.process_details["cmd"][1:]])
