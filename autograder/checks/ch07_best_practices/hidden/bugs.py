"""Robust nodes whose generator has a bug: what becomes of its exception in timer_callback."""

from __future__ import annotations

from typing import Any

from autograder.checks.ch07_best_practices.support.contract import ROBUST
from autograder.harness import Workspace
from autograder.probes.calls import Plan, StepResult, call, callback, calls, made
from autograder.probes.parameters import override_arguments

BUGS = ("AttributeError", "RuntimeError", "OSError", "ValueError")  # OSError is the base class of the given SensorError


def with_bugs(workspace: Workspace) -> tuple[dict[str, tuple[StepResult, StepResult, StepResult]], StepResult]:
    """Make a node for each bug, with a generator that has it, and call its timer_callback.

    Returns:
        By bug, what came of making the node, of the call, and of asking for its namespace. Then what came of the call
        of a node that has the last bug's generator and a seed.
    """
    plan = Plan()
    add = plan.add
    add(call("init", module="rclpy"))

    numbers = {}
    for bug in BUGS:
        if bug == "AttributeError":  # a generator without random()
            generator = add(call("Mock", module="unittest.mock", spec=[]))
        else:
            effect: dict[str, Any] = {"random.side_effect": made(add(call(bug, "a bug", module="builtins")))}
            generator = add(call("Mock", module="unittest.mock", **effect))
        node = add(call("RobustNode", generator=made(generator), namespace="hall"))
        numbers[bug] = node, add(callback("timer_callback", on=node)), add(call("get_namespace", on=node))
    seed = ["--ros-args", *override_arguments({"seed": 5})]
    node = add(call("RobustNode", generator=made(generator), cli_args=seed))
    add(callback("timer_callback", on=node))
    results = calls(workspace, ROBUST, *plan.steps, network=True)
    return {bug: (results[a], results[b], results[c]) for bug, (a, b, c) in numbers.items()}, results[-1]
