"""A robust node whose generator raises an exception in timer_callback."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch07_best_practices.support.contract import ROBUST

# RuntimeError is the base class of SensorError. OSError and its subclasses are what a real device raises.
PLAIN = ("AttributeError", "RuntimeError")
BUGS = (
    *PLAIN,
    *("OSError", "TimeoutError", "ConnectionError", "ValueError", "TypeError", "KeyError", "IndexError"),
    *("ZeroDivisionError", "EOFError", "AssertionError", "NotImplementedError"),
)


@dataclass(frozen=True)
class BugResults:
    """The results of creating a node, of reading its namespace, and of its callback for each bug.

    Attributes:
        seeded: the callback's result for a node that has a seed and the same generator, with the last bug.
    """

    created: calls.StepResult
    namespace: calls.StepResult
    called: dict[str, calls.StepResult]
    seeded: calls.StepResult


def call_with_bugs(workspace: Workspace) -> BugResults:
    """Create a node with a generator of one's own, and call its timer_callback once for each bug."""
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    generator = add(calls.call("Mock", module="unittest.mock"))
    number = calls.result_of(add(calls.attribute("random", on=generator)))
    node = add(calls.call("RobustNode", generator=calls.result_of(generator), namespace="hall"))
    namespace = add(calls.call("get_namespace", on=node))
    called = {}
    for bug in BUGS:
        error: Any = calls.result_of(add(calls.call(bug, "a bug", module="builtins")))
        add(calls.call("setattr", number, "side_effect", error, module="builtins"))
        called[bug] = add(calls.callback("timer_callback", on=node))
    seed = ["--ros-args", *parameters.override_arguments({"seed": 5})]
    other = add(calls.call("RobustNode", generator=calls.result_of(generator), cli_args=seed))
    add(calls.callback("timer_callback", on=other))
    results = calls.calls(workspace, ROBUST, *plan.steps, network=True)
    called_results = {bug: results[step] for bug, step in called.items()}
    return BugResults(results[node], results[namespace], called_results, results[-1])
