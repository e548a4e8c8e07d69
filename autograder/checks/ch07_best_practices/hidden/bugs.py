"""Robust nodes whose generator has a bug: what becomes of its exception in timer_callback."""

from __future__ import annotations

from typing import Any

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch07_best_practices.support.contract import ROBUST

BUGS = ("AttributeError", "RuntimeError", "OSError", "ValueError")  # OSError is the base class of the given SensorError


def with_bugs(
    workspace: Workspace,
) -> tuple[dict[str, tuple[calls.StepResult, calls.StepResult, calls.StepResult]], calls.StepResult]:
    """Make a node for each bug, with a generator that has it, and call its timer_callback.

    Returns:
        By bug, what came of making the node, of the call, and of asking for its namespace. Then what came of the call
        of a node that has the last bug's generator and a seed.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))

    numbers = {}
    for bug in BUGS:
        if bug == "AttributeError":  # a generator without random()
            generator = add(calls.call("Mock", module="unittest.mock", spec=[]))
        else:
            effect: dict[str, Any] = {
                "random.side_effect": calls.made(add(calls.call(bug, "a bug", module="builtins")))
            }
            generator = add(calls.call("Mock", module="unittest.mock", **effect))
        node = add(calls.call("RobustNode", generator=calls.made(generator), namespace="hall"))
        numbers[bug] = node, add(calls.callback("timer_callback", on=node)), add(calls.call("get_namespace", on=node))
    seed = ["--ros-args", *parameters.override_arguments({"seed": 5})]
    node = add(calls.call("RobustNode", generator=calls.made(generator), cli_args=seed))
    add(calls.callback("timer_callback", on=node))
    results = calls.calls(workspace, ROBUST, *plan.steps, network=True)
    return {bug: (results[a], results[b], results[c]) for bug, (a, b, c) in numbers.items()}, results[-1]
