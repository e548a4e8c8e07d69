"""The student's node on the bench: its methods are called without a harness, so that no request has to be sent."""

from __future__ import annotations

from autograder.checking import Workspace
from autograder.checking.probes import calls, parameters
from autograder.checks.ch05_parameters.support.contract import EXECUTABLE, PACKAGE

MODULE = f"{PACKAGE}.nodes.{EXECUTABLE}"


def judge(workspace: Workspace) -> tuple[parameters.Value, parameters.Value, parameters.Value]:
    """Ask validate alone, so that nothing is stored.

    Returns:
        The timer's period in ns before and after it judges 25 Hz; whether it takes a safety distance of 1.5 m after it
        has judged a slow distance of 2.0 m. None from a node with other names.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))

    def parameter(name: str, value: float) -> int:
        return add(calls.call("Parameter", name, value=value, module="rclpy.parameter"))

    def validate(parameter: int) -> int:
        add(calls.call("clear", on=request))
        add(calls.call("append", calls.made(parameter), on=request))
        return add(calls.call("validate", calls.made(request), on=node))

    def period() -> int:
        return add(calls.look("timer_period_ns", on=add(calls.look("timer", on=node))))

    node = add(calls.call("ConfiguredNode"))
    request = add(calls.call("list", module="builtins"))
    before = period()
    validate(parameter("control_frequency", 25.0))
    after = period()
    validate(parameter("slow_distance", 2.0))
    accepted = add(calls.look("successful", on=validate(parameter("safety_distance", 1.5))))
    outcomes = calls.calls(workspace, MODULE, *plan.steps, network=True)
    return outcomes[before].value, outcomes[after].value, outcomes[accepted].value


def set_use_sim_time(workspace: Workspace) -> parameters.Value:
    """Set use_sim_time to true beside a distance, without a harness, whose time goes by it.

    Returns:
        Its value after that; None from a node with other names.
    """
    plan = calls.Plan()
    add = plan.add
    add(calls.call("init", module="rclpy"))
    node, request = add(calls.call("ConfiguredNode")), add(calls.call("list", module="builtins"))
    for name, wanted in (("use_sim_time", True), ("slow_distance", 1.5)):
        parameter = add(calls.call("Parameter", name, value=wanted, module="rclpy.parameter"))
        add(calls.call("append", calls.made(parameter), on=request))
    add(calls.call("set_parameters_atomically", calls.made(request), on=node))
    stored = add(calls.look("value", on=add(calls.call("get_parameter", "use_sim_time", on=node))))
    value: parameters.Value = calls.calls(workspace, MODULE, *plan.steps, network=True)[stored].value
    return value
