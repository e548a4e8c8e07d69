"""Runs inside the sandbox: calls functions and classes of a student's module by an order in JSON, and answers in JSON.

    python call_runner.py ORDER_FD ANSWER_FD

The order, `{"module": ..., "steps": [...]}`, comes on one descriptor; steps are as in `autograder.probes.calls`. The
answer goes to another one, so that it does not contain the output of the student's code. The student's code can forge
the answer: the trusted side only compares its values.
"""

from __future__ import annotations

import builtins
import contextlib
import importlib
import inspect
import io
import json
import os
import sys
import traceback
from typing import Any

TEXT = 2000
REFERENCE = "$made"


def main() -> None:
    """Carry out the order."""
    with os.fdopen(int(sys.argv[1]), encoding="utf-8") as stream:
        order = json.load(stream)
    answer = os.fdopen(int(sys.argv[2]), "w", encoding="utf-8")
    try:
        module = importlib.import_module(order["module"])
    except Exception as error:
        json.dump({"failed": _exception(error)}, answer)
        return
    made: list[Any] = []
    outcomes = [_step(module, made, step) for step in order["steps"]]
    json.dump({"outcomes": outcomes}, answer)
    answer.flush()


def _step(module: Any, made: list[Any], step: dict[str, Any]) -> dict[str, Any]:
    arguments = [_resolved(made, value) for value in step["args"]]
    keywords = {name: _resolved(made, value) for name, value in step["kwargs"].items()}
    printed = io.StringIO()
    try:
        owner = importlib.import_module(step["module"]) if step["module"] else module
        target = getattr(owner if step["on"] is None else made[step["on"]], step["name"])
        with contextlib.redirect_stdout(printed):
            value = target(*arguments, **keywords) if step["called"] else target
            value = _begun(value) if step["begun"] else value
    except Exception as error:
        made.append(None)
        return _exception(error)
    made.append(value)
    outcome: dict[str, Any] = {"printed": printed.getvalue()[:TEXT]}
    try:
        return {
            **outcome,
            "value": json.loads(json.dumps(value)),
            "arguments": json.loads(json.dumps(arguments, default=repr)),
        }
    except (TypeError, ValueError, RecursionError):
        return {**outcome, "type": type(value).__name__}


def _begun(value: Any) -> Any:
    """Return the result of a call. For a coroutine, return its result if it ends before it waits."""
    if not inspect.iscoroutine(value):
        return value
    try:
        value.send(None)
    except StopIteration as end:
        return end.value
    value.close()
    return None


def _resolved(made: list[Any], value: Any) -> Any:
    """Return the argument, or the result of an earlier step if it refers to one."""
    return made[value[REFERENCE]] if isinstance(value, dict) and REFERENCE in value else value


def _exception(error: Exception) -> dict[str, Any]:
    trace = "".join(traceback.format_exception(error))
    kinds = [kind.__name__ for kind in type(error).__mro__ if getattr(builtins, kind.__name__, kind) is kind]
    return {"raised": type(error).__name__, "kinds": kinds, "message": str(error)[:TEXT], "traceback": trace[-TEXT:]}


if __name__ == "__main__":
    main()
