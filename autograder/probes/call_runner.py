"""Runs inside the sandbox: calls functions and classes of a student's module, as a JSON request specifies.

    python call_runner.py REQUEST_FD ANSWER_FD

The request, `{"module": ..., "steps": [...]}`, is read from one descriptor. Its steps are those of
`autograder.probes.calls`. The answer, in JSON, is written to the other one, so that it does not contain the output of
the student's code. The student's code can forge the answer: the trusted side only compares its values.
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

MAX_TEXT = 2000  # characters
REFERENCE = "$made"  # the key of an argument that is the result of an earlier step


def main() -> None:
    """Execute the request's steps and write their outcomes."""
    with os.fdopen(int(sys.argv[1]), encoding="utf-8") as stream:
        request = json.load(stream)
    answer = os.fdopen(int(sys.argv[2]), "w", encoding="utf-8")
    try:
        module = importlib.import_module(request["module"])
    except Exception as error:
        json.dump({"failed": _exception(error)}, answer)
        return
    results: list[Any] = []
    outcomes = [_step(module, results, step) for step in request["steps"]]
    json.dump({"outcomes": outcomes}, answer)
    answer.flush()


def _step(module: Any, results: list[Any], step: dict[str, Any]) -> dict[str, Any]:
    arguments = [_resolve(results, value) for value in step["args"]]
    keywords = {name: _resolve(results, value) for name, value in step["kwargs"].items()}
    printed = io.StringIO()
    try:
        owner = importlib.import_module(step["module"]) if step["module"] else module
        target = getattr(owner if step["on"] is None else results[step["on"]], step["name"])
        with contextlib.redirect_stdout(printed):
            value = target(*arguments, **keywords) if step["is_call"] else target
            value = _run_coroutine(value) if step["runs_coroutine"] else value
    except Exception as error:
        results.append(None)
        return _exception(error)
    results.append(value)
    outcome: dict[str, Any] = {"printed": printed.getvalue()[:MAX_TEXT]}
    try:
        return {
            **outcome,
            "value": json.loads(json.dumps(value)),
            "arguments": json.loads(json.dumps(arguments, default=repr)),
        }
    except (TypeError, ValueError, RecursionError):
        return {**outcome, "type": type(value).__name__}


def _run_coroutine(value: Any) -> Any:
    """Run a coroutine until it first waits; return its result, or None if it has not ended. Return any other value."""
    if not inspect.iscoroutine(value):
        return value
    try:
        value.send(None)
    except StopIteration as stop:
        return stop.value
    value.close()
    return None


def _resolve(results: list[Any], value: Any) -> Any:
    """Return an argument's value: the result of an earlier step if it refers to one, otherwise the argument itself."""
    return results[value[REFERENCE]] if isinstance(value, dict) and REFERENCE in value else value


def _exception(error: Exception) -> dict[str, Any]:
    text = "".join(traceback.format_exception(error))
    kinds = [kind.__name__ for kind in type(error).__mro__ if getattr(builtins, kind.__name__, kind) is kind]
    return {
        "raised": type(error).__name__,
        "kinds": kinds,
        "message": str(error)[:MAX_TEXT],
        "traceback": text[-MAX_TEXT:],
    }


if __name__ == "__main__":
    main()
