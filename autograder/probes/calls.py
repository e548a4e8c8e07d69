"""Calls a student's functions in the sandbox. Arguments and results are JSON values of limited size.

    outcomes = run_steps(workspace, "wheels.data_processing",
                         call("mask_invalid", [1.0, nan], 0.1, 3.5),
                         call("DataProcessor", history=2), call("process", [1.0], 0.1, 3.5, on=1),
                         attribute("history", on=1))

Values are those of JSON: bool, int, float (including nan and infinities), str, list, dict and None. A tuple is returned
as a list. For any other value, the name of its type is returned. Each step has an outcome, in order.
"""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.run.lockstep.failures import diagnose_crash, diagnose_exit
from autograder.run.lockstep.protocol import Crash
from autograder.run.lockstep.tracebacks import student_frames
from autograder.run.sandbox import Mount, Process
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import CALLS
from autograder.run.workspace import Workspace
from autograder.submission.reading import beyond_bounds, reading
from autograder.suite import CheckFailed

REFERENCE = "$made"  # the same as in call_runner.py, which cannot import this module in the sandbox
RUNNER = Path(__file__).with_name("call_runner.py")
MAX_ANSWER = 1024 * 1024
MAX_KINDS = 20


@dataclass(frozen=True)
class Step:
    """A call, or an access to an attribute."""

    name: str  # a function, class or attribute
    args: tuple[Any, ...] = ()  # positional arguments, JSON or `result_of(N)`
    kwargs: Mapping[str, Any] = field(default_factory=dict)  # keyword arguments, JSON or `result_of(N)`
    on: int | None = None  # the number of the step whose result has `name`; None for the module
    module: str | None = None  # another module that has `name`, such as `random`; None for the student's
    is_call: bool = True  # whether `name` is called, or only read
    runs_coroutine: bool = False  # whether a coroutine that it returns is run until it first waits


@dataclass(frozen=True)
class StepResult:
    """The result of a step."""

    value: Any = None  # the returned value as JSON, or None
    type: str = ""  # the name of the returned value's type if JSON cannot represent the value; empty otherwise
    raised: str = ""  # the name of the exception that the step raised, or empty
    message: str = ""  # the text of that exception
    kinds: tuple[str, ...] = ()  # the names of the exception's class and its base classes, in this order
    arguments: tuple[Any, ...] = ()  # the arguments after the call, which may have changed them
    printed: str = ""  # the output of the step


def call(name: str, *args: Any, on: int | None = None, module: str | None = None, **kwargs: Any) -> Step:
    """Return a step that calls a function or a class. `Step` explains the arguments."""
    return Step(name, args, kwargs, on, module)


def callback(name: str, *, on: int) -> Step:
    """Return a step that calls a node's callback as an executor does, and runs the coroutine that it may return."""
    return Step(name, on=on, runs_coroutine=True)


def result_of(number: int) -> dict[str, int]:
    """Return an argument that refers to the result of step `number`."""
    return {REFERENCE: number}


def attribute(name: str, *, on: int | None = None) -> Step:
    """Return a step that reads an attribute of the module, or of the result of step `on`."""
    return Step(name, on=on, is_call=False)


class Plan:
    """A list of steps, each identified by its number."""

    def __init__(self) -> None:
        self.steps: list[Step] = []

    def add(self, step: Step) -> int:
        """Add a step; return its number, for `on` and `result_of`."""
        self.steps.append(step)
        return len(self.steps) - 1


def run_steps(workspace: Workspace, module: str, *steps: Step, network: bool = False) -> list[StepResult]:
    """Execute steps in one sandboxed process; return their outcomes.

    Args:
        workspace: the workspace in which the module is installed.
        module: the dotted name of the student's module.
        steps: the steps, in order.
        network: whether the process may use DDS, which ROS needs.

    Raises:
        StudentError: the module cannot be imported, or its code hangs, ends the process or goes over a limit.
    """
    spec = workspace.sandbox(CALLS)
    spec = replace(spec, network=network, mounts=(*spec.mounts, Mount(RUNNER)))
    request = json.dumps({"module": module, "steps": [asdict(step) for step in steps]})
    with (
        os.fdopen(os.memfd_create("request"), "w+b") as request_file,
        os.fdopen(os.memfd_create("answer"), "w+b") as answer_file,
    ):
        request_file.write(request.encode())
        request_file.seek(0)
        descriptors = request_file.fileno(), answer_file.fileno()
        command = [sys.executable, str(RUNNER), *map(str, descriptors)]
        with launch(command, spec, pass_fds=descriptors, profile="tests") as process:
            process.wait(CALLS.wall_seconds + 10)
            answer_file.seek(0)
            return parse_answer(answer_file.read(MAX_ANSWER + 1), module, len(steps), process)


def parse_answer(data: bytes, module: str, count: int, process: Process) -> list[StepResult]:
    """Read the answer of a process that was asked to execute `count` steps with a module.

    Raises:
        StudentError: the module could not be imported, the answer is truncated, or `call_runner` did not write it.
    """
    with reading(f"The answer of {module}"):
        answer = _parse(data)
        if answer is not None and "failed" in answer:
            raise StudentError(_import_diagnosis(module, answer["failed"]))
        outcomes = None if answer is None else answer.get("outcomes")
        if not isinstance(outcomes, list) or len(outcomes) != count:
            raise StudentError(diagnose_exit(process))
        return [_outcome(outcome) for outcome in outcomes]


def value(outcome: StepResult, expression: str) -> Any:
    """Return an outcome's value; `expression` is the call as the student would write it.

    Raises:
        CheckFailed: the step raised an exception, or returned a value that JSON cannot represent.
    """
    if outcome.raised == "NotImplementedError":
        raise CheckFailed(f"{expression} is still to be written.")
    if outcome.raised:
        raise CheckFailed(f"{expression} raised {outcome.raised}: {outcome.message}")
    if outcome.type:
        raise CheckFailed(f"{expression} returned a value of type {outcome.type}, instead of plain Python values.")
    return outcome.value


def same(one: Any, other: Any) -> bool:
    """Return whether two JSON values are equal.

    nan equals nan, an int never equals a bool, and floats may differ by 1e-9.
    """
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, bool) or isinstance(other, bool) or one is None or other is None:
        return one is other
    if isinstance(one, int | float) and isinstance(other, int | float):
        return (math.isnan(one) and math.isnan(other)) or one == other or math.isclose(one, other, rel_tol=1e-9)
    return type(one) is type(other) and one == other


def _parse(text: bytes) -> dict[str, Any] | None:
    try:
        answer = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return answer if isinstance(answer, dict) else None


def _import_diagnosis(module: str, failure: object) -> Diagnosis:
    data = failure if isinstance(failure, dict) else {}
    kind, message, traceback_text = (str(data.get(name, "")) for name in ("raised", "message", "traceback"))
    if kind == "ModuleNotFoundError" and module in message:
        sentence = f"The package installs no module {module}: is its file written? Check its folder, __init__.py "
        frames = student_frames(traceback_text)  # all frames if none is the student's, and then all are the loader's
        detail = frames if frames != traceback_text else ""
        return Diagnosis(Kind.CRASHED_AT_IMPORT, f"{sentence}and `packages` in setup.py.", detail)
    return diagnose_crash(Crash("import", kind, message, traceback_text))


def _outcome(data: object) -> StepResult:
    data = data if isinstance(data, dict) else {}
    arguments, kinds = data.get("arguments"), data.get("kinds")
    excess = beyond_bounds(data.get("value")) or beyond_bounds(arguments)
    if excess:
        return StepResult(type=excess)
    return StepResult(
        value=data.get("value"),
        type=str(data.get("type", "")),
        raised=str(data.get("raised", "")),
        message=str(data.get("message", ""))[:300],
        kinds=tuple(map(str, kinds[:MAX_KINDS])) if isinstance(kinds, list) else (),
        arguments=tuple(arguments) if isinstance(arguments, list) else (),
        printed=str(data.get("printed", "")),
    )
