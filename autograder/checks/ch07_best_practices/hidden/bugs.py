"""Calls a robust node whose generator raises an exception in timer_callback."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch07_best_practices.support.contract import ROBUST

# RuntimeError is the base class of SensorError. OSError and its subclasses are what a real device raises.
PLAIN_BUGS = ("AttributeError", "RuntimeError")
BUGS = (
    *PLAIN_BUGS,
    *("OSError", "TimeoutError", "ConnectionError", "ValueError", "TypeError", "KeyError", "IndexError"),
    *("ZeroDivisionError", "EOFError", "AssertionError", "NotImplementedError"),
)


@dataclass(frozen=True)
class BugResults:
    """The results of creating a node, of reading its namespace, and of its callback for each bug.

    Attributes:
        seeded_callback: the callback's result, with the last bug, for a node that has a seed and the same generator.
    """

    creation: calls.StepResult
    namespace: calls.StepResult
    callbacks: dict[str, calls.StepResult]
    seeded_callback: calls.StepResult


def call_with_bugs(workspace: Workspace) -> BugResults:
    """Create a node with a mock generator, and call the node's timer_callback once for each bug."""
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    generator = add(calls.call("Mock", module="unittest.mock"))
    number = calls.result_of(add(calls.attribute("random", on=generator)))
    node = add(calls.call("RobustNode", generator=calls.result_of(generator), namespace="hall"))
    namespace = add(calls.call("get_namespace", on=node))
    callback_steps = {}
    for bug in BUGS:
        error: Any = calls.result_of(add(calls.call(bug, "a bug", module="builtins")))
        add(calls.call("setattr", number, "side_effect", error, module="builtins"))
        callback_steps[bug] = add(calls.callback("timer_callback", on=node))
    seed = ["--ros-args", *parameters.override_arguments({"seed": 5})]
    seeded_node = add(calls.call("RobustNode", generator=calls.result_of(generator), cli_args=seed))
    add(calls.callback("timer_callback", on=seeded_node))
    results = calls.run_steps(workspace, ROBUST, *plan.steps, network=True)
    callback_results = {bug: results[step] for bug, step in callback_steps.items()}
    return BugResults(results[node], results[namespace], callback_results, results[-1])
