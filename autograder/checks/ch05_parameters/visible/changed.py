"""Checks of parameter changes at run time."""

from __future__ import annotations

from autograder.checking import expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.robot import Robot, expect_rate, expect_speed

check = group("changes")
PAIR: dict[str, parameters.Value] = {"safety_distance": 1.5, "slow_distance": 2.0}


@check(points=1, covers=("contradiction", "reason"), needs=("starts",), after=("table",), doc=contract.PARAMETERS)
@hint("proposed = {parameter.name: parameter.value for parameter in parameters} holds the values of the request.")
@hint("proposed.get('slow_distance', self.value('slow_distance')) is the slow distance after the request.")
def test_contradiction(robot: Robot) -> None:
    """The node refuses two distances that do not fit or are equal; its reason names both, with their values."""
    answer = robot.change({"safety_distance": 1.5})
    expect(not answer.accepted, "With a slow_distance of 1.0 m, it accepted a safety_distance of 1.5 m.")
    names_both = all(part in answer.reason for part in (*PAIR, "1.5"))
    message = "Its reason for refusing a safety_distance of 1.5 m does not name both distances with their values"
    expect(names_both, f"{message}: “{answer.reason}”.")
    answer = robot.change({"slow_distance": 0.3})
    expect(not answer.accepted, "With a safety_distance of 0.5 m, it accepted a slow_distance of 0.3 m.")
    answer = robot.change({"safety_distance": 0.7, "slow_distance": 0.7})
    expect(not answer.accepted, "It accepted 0.7 m for both distances in one request.")


@check(points=1, covers=("keep-value", "at-once"), needs=("starts",), after=("contradiction",))
@hint("Judge the distances as they would be after the whole request, not one value after the other.")
@hint("The given method speed asks for both distances at each command.")
def test_together(robot: Robot) -> None:
    """The node accepts two distances in one request, and uses them; then it accepts a safety distance of 1.8 m."""
    answer = robot.change(PAIR)
    expect(answer.accepted, f"It refused distances of 1.5 m and 2.0 m in one request: “{answer.reason}”.")
    expect_speed(robot.speed_at(1.4), 0.0, "With a safety distance of 1.5 m and a wall 1.4 m ahead")
    expect_speed(robot.speed_at(2.1), 0.3, "With a slow distance of 2.0 m and a wall 2.1 m ahead")
    answer = robot.change({"safety_distance": 1.8})
    expect(answer.accepted, f"With a slow_distance of 2.0 m, it refused a safety_distance of 1.8 m: “{answer.reason}”.")


@check(points=1, covers="apply-rate", needs=("starts",), after=("table",))
@hint("In apply, look for control_frequency among the names of the changed parameters.")
@hint("self.timer.timer_period_ns = round(1e9 / frequency)")
def test_rate(robot: Robot) -> None:
    """A new control_frequency sets the rate of the commands."""
    answer = robot.change({"control_frequency": 20.0})
    expect(answer.accepted, f"It refused a control_frequency of 20 Hz: “{answer.reason}”.")
    expect_rate(robot.command_rate(1.0), 20.0, "After control_frequency was set to 20.0")


@check(points=1, covers="no-effect", needs=("starts",), after=("contradiction", "rate"))
@hint("validate only returns an answer. Every action belongs in apply.")
def test_refused_whole(robot: Robot) -> None:
    """A refused request for 30 Hz and a safety distance of 2.5 m does not change the rate."""
    answer = robot.change({"control_frequency": 30.0, "safety_distance": 2.5})
    expect(not answer.accepted, "With a slow_distance of 1.0 m, it accepted a safety_distance of 2.5 m.")
    expect_rate(robot.command_rate(1.0), 10.0, "After a refused request for 30 Hz")


@check(points=1, covers="lets-pass", needs=("starts",), after=("contradiction",))
@hint("Judge only the two distances: a request that does not name them is successful.")
def test_lets_pass(robot: Robot) -> None:
    """The node accepts a request for battery_threshold and use_sim_time, without a distance."""
    answer = robot.change({"battery_threshold": 45, **robot.parameters.values("use_sim_time")})
    expect(answer.accepted, f"It refused a request for battery_threshold and use_sim_time: “{answer.reason}”.")
