"""Robust nodes whose generator raises an exception in timer_callback."""

from __future__ import annotations

from typing import Any

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch07_best_practices.support.contract import ROBUST

BUGS = ("AttributeError", "RuntimeError", "OSError", "ValueError")  # OSError is the base class of the given SensorError


def call_with_bugs(
    workspace: Workspace,
) -> tuple[dict[str, tuple[calls.StepResult, calls.StepResult, calls.StepResult]], calls.StepResult]:
    """Create a node for each bug, with a generator that has the bug, and call its timer_callback.

    Returns:
        By bug, the results of creating the node, of the call, and of reading its namespace. Then the result of the call
        for a node with a seed and the last bug's generator.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))

    steps_of = {}
    for bug in BUGS:
        if bug == "AttributeError":  # a generator without random()
            generator = add(calls.call("Mock", module="unittest.mock", spec=[]))
        else:
            effect: dict[str, Any] = {
                "random.side_effect": calls.result_of(add(calls.call(bug, "a bug", module="builtins")))
            }
            generator = add(calls.call("Mock", module="unittest.mock", **effect))
        node = add(calls.call("RobustNode", generator=calls.result_of(generator), namespace="hall"))
        steps_of[bug] = node, add(calls.callback("timer_callback", on=node)), add(calls.call("get_namespace", on=node))
    seed = ["--ros-args", *parameters.override_arguments({"seed": 5})]
    node = add(calls.call("RobustNode", generator=calls.result_of(generator), cli_args=seed))
    add(calls.callback("timer_callback", on=node))
    results = calls.calls(workspace, ROBUST, *plan.steps, network=True)
    return {bug: (results[i], results[j], results[k]) for bug, (i, j, k) in steps_of.items()}, results[-1]
