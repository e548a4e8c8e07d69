"""Checks of parameter changes at run time."""

from __future__ import annotations

from autograder.checking import expect, group, hint
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import contract
from autograder.checks.ch05_parameters.support.robot import Robot, expect_rate, expect_speed

check = group("changes")
PAIR: dict[str, parameters.Value] = {"safety_distance": 1.5, "slow_distance": 2.0}


@check(points=1, covers=("contradiction", "reason"), needs=("starts",), after=("table",), doc=contract.PARAMETERS)
@hint("proposed = {parameter.name: parameter.value for parameter in parameters} is what the request asks for.")
@hint("proposed.get('slow_distance', self.value('slow_distance')) is what it will be.")
def test_contradiction(robot: Robot) -> None:
    """It refuses distances that do not fit, whichever is set, and equal ones; its reason names both, with values."""
    answer = robot.change({"safety_distance": 1.5})
    expect(not answer.accepted, "With a slow_distance of 1.0 m, it took 1.5 m for safety_distance.")
    names_both = all(part in answer.reason for part in (*PAIR, "1.5"))
    expect(names_both, f"It refused 1.5 m for safety_distance; its reason was “{answer.reason}”.")
    answer = robot.change({"slow_distance": 0.3})
    expect(not answer.accepted, "With a safety_distance of 0.5 m, it took 0.3 m for slow_distance.")
    answer = robot.change({"safety_distance": 0.7, "slow_distance": 0.7})
    expect(not answer.accepted, "It took 0.7 m for both distances in one request.")


@check(points=1, covers=("keep-value", "at-once"), needs=("starts",), after=("contradiction",))
@hint("Judge what will be, with all the values of the request; not one value after the other.")
@hint("speed, which is given, asks for both distances at each command.")
def test_together(robot: Robot) -> None:
    """It takes both distances in one request, and stops where they say; 1.8 m then fits the slow distance of 2.0 m."""
    answer = robot.change(PAIR)
    expect(answer.accepted, f"It refused 1.5 m and 2.0 m in one request: “{answer.reason}”.")
    expect_speed(robot.speed_at(1.4), 0.0, "With a safety distance of 1.5 m and a wall 1.4 m ahead")
    expect_speed(robot.speed_at(2.1), 0.3, "With a slow distance of 2.0 m and a wall 2.1 m ahead")
    answer = robot.change({"safety_distance": 1.8})
    expect(answer.accepted, f"With a slow distance of 2.0 m, it refused 1.8 m: “{answer.reason}”.")


@check(points=1, covers="apply-rate", needs=("starts",), after=("table",))
@hint("In apply, look for control_frequency among the names of what has changed.")
@hint("self.timer.timer_period_ns = round(1e9 / frequency)")
def test_rate(robot: Robot) -> None:
    """A new control_frequency sets the rate of its commands."""
    answer = robot.change({"control_frequency": 20.0})
    expect(answer.accepted, f"It refused 20 Hz: “{answer.reason}”.")
    expect_rate(robot.command_rate(1.0), 20.0, "After control_frequency was set to 20.0")


@check(points=1, covers="no-effect", needs=("starts",), after=("contradiction", "rate"))
@hint("validate only returns an answer. Whatever has to be done stands in apply.")
def test_refused_whole(robot: Robot) -> None:
    """A request that it refuses, for 30 Hz and a safety distance of 2.5 m, leaves the rate as it was."""
    answer = robot.change({"control_frequency": 30.0, "safety_distance": 2.5})
    expect(not answer.accepted, "With a slow_distance of 1.0 m, it took 2.5 m for safety_distance.")
    expect_rate(robot.command_rate(1.0), 10.0, "After a refused request for 30 Hz")


@check(points=1, covers="lets-pass", needs=("starts",), after=("contradiction",))
@hint("Look for the two distances in the request, and for nothing else: other names are not yours to refuse.")
def test_lets_pass(robot: Robot) -> None:
    """It takes a request for battery_threshold and use_sim_time, which name no distance."""
    answer = robot.change({"battery_threshold": 45, **robot.parameters.values("use_sim_time")})
    expect(answer.accepted, f"It refused a request for battery_threshold and use_sim_time: “{answer.reason}”.")
