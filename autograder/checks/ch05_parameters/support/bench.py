"""Calls the student's functions and methods without a harness, so that no request has to be sent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, EXECUTABLE, PACKAGE

CONFIGURATION = f"{PACKAGE}.configuration"
MODULE = f"{PACKAGE}.nodes.{EXECUTABLE}"
# Options of a node that is created quickly.
BARE_OPTIONS: dict[str, Any] = {"start_parameter_services": False, "enable_rosout": False}


class StartOutcome(NamedTuple):
    """The results of two calls for a start: of contradiction, and of declare_configuration."""

    contradiction: calls.StepResult
    declaration: calls.StepResult


def declare(workspace: Workspace, starts: Sequence[Mapping[str, parameters.Value]]) -> list[StartOutcome]:
    """For each of these sets of start values, call declare_configuration on a new node."""
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    steps = []
    for values in starts:
        distances = (values.get(name, DEFAULTS[name]) for name in ("safety_distance", "slow_distance"))
        arguments = ["--ros-args", *parameters.override_arguments(values)]
        node = add(calls.call("Node", "bench", module="rclpy.node", cli_args=arguments, **BARE_OPTIONS))
        declaration = add(calls.call("declare_configuration", calls.result_of(node)))
        steps.append((add(calls.call("contradiction", *distances)), declaration))
    outcomes = calls.run_steps(workspace, CONFIGURATION, *plan.steps, network=True)
    return [StartOutcome(outcomes[contradiction], outcomes[declaration]) for contradiction, declaration in steps]


def call_validate(workspace: Workspace) -> tuple[parameters.Value, parameters.Value, parameters.Value]:
    """Call only validate, so that nothing is stored.

    Returns:
        The timer's period in ns before and after a call with 25 Hz; and whether a safety distance of 1.5 m is accepted
        after a call with a slow distance of 2.0 m. Each is None if the node lacks the names that the call needs.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))

    def parameter(name: str, value: float) -> int:
        return add(calls.call("Parameter", name, value=value, module="rclpy.parameter"))

    def validate(parameter: int) -> int:
        add(calls.call("clear", on=request))
        add(calls.call("append", calls.result_of(parameter), on=request))
        return add(calls.call("validate", calls.result_of(request), on=node))

    def period() -> int:
        return add(calls.attribute("timer_period_ns", on=add(calls.attribute("timer", on=node))))

    node = add(calls.call("ConfiguredNode"))
    request = add(calls.call("list", module="builtins"))
    period_before = period()
    validate(parameter("control_frequency", 25.0))
    period_after = period()
    validate(parameter("slow_distance", 2.0))
    acceptance = add(calls.attribute("successful", on=validate(parameter("safety_distance", 1.5))))
    outcomes = calls.run_steps(workspace, MODULE, *plan.steps, network=True)
    return outcomes[period_before].value, outcomes[period_after].value, outcomes[acceptance].value


def set_use_sim_time(workspace: Workspace) -> parameters.Value:
    """Set use_sim_time to true, together with a distance, in one request.

    A harness cannot do this, because its clock depends on use_sim_time.

    Returns:
        The value of use_sim_time afterwards; None if the node's class has another name.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    node, request = add(calls.call("ConfiguredNode")), add(calls.call("list", module="builtins"))
    for name, new_value in (("use_sim_time", True), ("slow_distance", 1.5)):
        parameter = add(calls.call("Parameter", name, value=new_value, module="rclpy.parameter"))
        add(calls.call("append", calls.result_of(parameter), on=request))
    add(calls.call("set_parameters_atomically", calls.result_of(request), on=node))
    value_step = add(calls.attribute("value", on=add(calls.call("get_parameter", "use_sim_time", on=node))))
    value: parameters.Value = calls.run_steps(workspace, MODULE, *plan.steps, network=True)[value_step].value
    return value
