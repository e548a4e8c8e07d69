"""Checks of parameter changes at run time: validated together, without side effects, and applied immediately."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping

from autograder.checking import LOCKSTEP, Workspace, expect, group, hint
from autograder.checking.probes import calls, parameters
from autograder.checks.ch05_parameters.support import bench, contract
from autograder.checks.ch05_parameters.support.answers import expect_answers
from autograder.checks.ch05_parameters.support.contract import DEFAULTS, PACKAGE
from autograder.checks.ch05_parameters.support.drawn_requests import (
    ACCEPTED,
    ANY_VALUES,
    DISTANCES,
    FOREIGN,
    REFUSED,
    WITHOUT_DISTANCES,
    dialogues,
    values_text,
)
from autograder.checks.ch05_parameters.support.robot import Robot, expect_rate, expect_speed, missing_from, scan

check = group("changes")
DEFAULT_SPEED = 0.3  # m/s
CONTRADICTION = {"safety_distance": 2.5, "slow_distance": 0.25}  # m
UNEVEN_RATES = (31.6, 40.6, 46.5)  # Hz: rounded to whole hertz or whole milliseconds, they are off by about 1 % or more
LOCKSTEP_TOLERANCE = 0.005  # the tolerance in lockstep, as a share of the expected rate


@check(
    points=3,
    covers=("contradiction", "refused", "keep-value"),
    needs=("starts",),
    after=("names",),
    doc=contract.PARAMETERS,
)
@hint("add_on_set_parameters_callback(self.validate) in __init__; it returns SetParametersResult(successful=...).")
@hint("A distance that the request does not name keeps its value: proposed.get(name, self.value(name)).")
def test_contradiction(robot: Robot, draw: random.Random) -> None:
    """A safety distance that would not be below the slow distance is refused, whichever of the two is set."""
    above, below = draw_contradictions(draw)
    above, below = robot.allowed("safety_distance", above), robot.allowed("slow_distance", below)
    both = {"safety_distance": above, "slow_distance": robot.allowed("slow_distance", above - 0.2)}
    for request in ({"safety_distance": above}, {"slow_distance": below}, both):
        accepted = robot.change(request).accepted
        expect(
            not accepted,
            f"With a slow_distance of 1.0 m and a safety_distance of 0.5 m, it accepted {values_text(request)}.",
        )
    expect_answers(robot, dialogues(REFUSED), draw, tested_answers=(False,), fraction=0.5)


@check(points=1, covers=("reason", "refused", "keep-value"), needs=("starts",), after=("contradiction",))
@hint("SetParametersResult(successful=False, reason=...), with contradiction's sentence.")
@hint("For a distance that a request does not name, use the present value, not the default or the start value.")
def test_reason(robot: Robot, draw: random.Random, workspace: Workspace) -> None:
    """The reason for a refusal names both distances and their values."""
    safety, slow, far, near = draw_distances(draw)
    safety, far = (robot.allowed("safety_distance", distance) for distance in (safety, far))
    slow, near = (robot.allowed("slow_distance", distance) for distance in (slow, near))
    current = {"safety_distance": safety, "slow_distance": slow}
    for name in reversed(DISTANCES):  # each distance also fits the default of the other one
        _change(robot, {name: current[name]})
    requests = [{"safety_distance": far}, {"slow_distance": near}, {"slow_distance": near, "safety_distance": far}]
    pairs: list[dict[str, float]] = [{**current, **request} for request in requests]
    outcomes = calls.run_steps(
        workspace, f"{PACKAGE}.configuration", *(calls.call("contradiction", *pair.values()) for pair in pairs)
    )
    for request, pair, outcome in zip(requests, pairs, outcomes, strict=True):
        answer = robot.change(request)
        reason, sentence = answer.reason, parameters.shortened(str(outcome.value))
        request_text = values_text(request)
        expect(not answer.accepted, f"With {values_text(current)}, it accepted {request_text}.", fraction=0.5)
        missing = missing_from(reason, pair)
        observation = f"With {values_text(current)}, its reason for refusing {request_text} is “{reason}”"
        fraction = 0.5 if reason or request is not requests[0] else 0.0
        expect(not missing, f"{observation}, which does not name {', '.join(missing)}.", fraction=fraction)
        message = f"{observation}, without the sentence of contradiction: “{sentence}”."
        expect(sentence[:100] in reason, message, fraction=0.5)


@check(points=2, covers="validate", needs=("starts",), after=("names",))
@hint("Judge the distances as they would be after the whole request, not one value after the other.")
def test_together(robot: Robot, draw: random.Random) -> None:
    """Two distances that fit are accepted in one request, in either order, even far from the present ones."""
    far = robot.allowed("safety_distance", round(draw.uniform(1.4, 1.8), 2))
    request: dict[str, parameters.Value] = {
        "safety_distance": far,
        "slow_distance": robot.allowed("slow_distance", far + 0.5, up=True),
    }
    _change(robot, request)
    expected = parameters.as_declared(request, robot.initial)
    differences = parameters.differences(robot.parameters.values(*request), expected)
    expect(not differences, f"It accepted {values_text(request)}, but {'; '.join(differences)}.")
    expect_answers(robot, dialogues(ACCEPTED), draw, tested_answers=(True,), fraction=0.5)


@check(points=2, covers="no-effect", needs=("starts",), after=("contradiction",), doc=contract.PARAMETERS)
@hint("validate only says yes or no: it sets no attribute and no timer, and logs no change.")
@hint("The actions that follow an accepted request belong in apply.")
def test_no_side_effects(fresh_robot: Robot, draw: random.Random, workspace: Workspace) -> None:
    """A refused request changes nothing: no value, no speed, no rate."""
    robot = fresh_robot
    request: dict[str, parameters.Value] = {
        "control_frequency": 25.0,
        "max_linear_velocity": 0.8,
        "safety_distance": 2.0,
    }
    for name in reversed(DISTANCES):
        if robot.initial.get(name) != DEFAULTS[name]:
            _change(robot, {name: DEFAULTS[name]})
    current, rate, speed = robot.parameters.values(*request), robot.command_rate(), robot.speed_at(2.5)
    start = robot.seconds
    answer = robot.change(request)
    robot.advance(0.2)  # shorter than the time without a scan after which the robot stops
    if not answer.accepted:
        commands = robot.messages("/cmd_vel", since=start)
        present_speed = commands[-1].message.linear.x if commands else math.nan
        expect_speed(present_speed, speed, "Right after a refused request, with a wall 2.5 m ahead")
        differences = parameters.differences(robot.parameters.values(*request), current)
        expect(not differences, f"It refused {values_text(request)}, but {'; '.join(differences)}.")
        expect_speed(robot.speed_at(2.5), speed, "After a refused request for 0.8 m/s, with a wall 2.5 m ahead")
        expect_rate(robot.command_rate(), rate, "After a refused request for 25 Hz")
        _change(robot, {"battery_threshold": 25}, fraction=0.75)
        situation = "After a refused request for 25 Hz and an accepted one without a frequency"
        expect_rate(robot.command_rate(), rate, situation, fraction=0.75)
        after_a_refusal = dialogues(WITHOUT_DISTANCES, ACCEPTED, REFUSED, first=REFUSED, is_clear=True)
        expect_answers(robot, after_a_refusal, draw, fraction=0.75)
    period_before, period_after, accepted = bench.call_validate(workspace)
    observation = (
        f"While validate judged a request for 25 Hz, the timer's period went from {period_before} to {period_after} ns"
    )
    expect(period_before == period_after, f"{observation}, but another callback may still refuse it.", fraction=0.75)
    observation = f"With a slow_distance of 1.0 m, it accepted {values_text(request)}"
    expect(not answer.accepted, f"{observation}.", fraction=0.5)
    observation = "validate accepted slow_distance = 2.0, which was not stored, and then safety_distance = 1.5"
    expect(accepted is not True, f"{observation}, although slow_distance is still 1.0.", fraction=0.75)


@check(points=2, covers="at-once", needs=("starts",), after=("names",), doc=contract.IN_A_CLASS)
@hint("A value that is copied to an attribute in __init__ does not change with its parameter.")
@hint("The given method speed calls self.value(...) at each command: leave it so, or update your copies in apply.")
def test_speed_change(robot: Robot, draw: random.Random) -> None:
    """The robot immediately drives at a new max_linear_velocity."""
    expect_speed(robot.speed_at(2.5), DEFAULT_SPEED, "With the defaults and a wall 2.5 m ahead")
    speed = robot.allowed("max_linear_velocity", draw.randrange(45, 90) / 100)
    _change(robot, {"max_linear_velocity": speed})
    expect_speed(robot.speed_at(2.5), speed, f"After max_linear_velocity was set to {speed}")


@check(points=2, covers=("at-once", "contradiction"), needs=("starts",), after=("names",))
@hint("The speed of each command depends on the present values of both distances.")
def test_distance_change(robot: Robot, draw: random.Random) -> None:
    """New distances immediately change where the robot slows down and where it stops."""
    safety = robot.allowed("safety_distance", draw.randrange(110, 150) / 100)
    slow = robot.allowed("slow_distance", round(safety + 0.6, 2), up=True)
    both: dict[str, parameters.Value] = {"slow_distance": slow, "safety_distance": safety}
    if not robot.change(both).accepted:  # other checks test a request with both
        for name, value in both.items():
            _change(robot, {name: value})
    for distance, speed in ((safety - 0.1, 0.0), ((safety + slow) / 2, DEFAULT_SPEED / 2), (slow + 0.1, DEFAULT_SPEED)):
        situation = f"With distances of {safety:.2f} m and {slow:.2f} m, and a wall {distance:.2f} m ahead"
        expect_speed(robot.speed_at(distance), speed, situation)
    near = robot.allowed("slow_distance", round(safety + 0.004, 3))  # 4 mm above it, if the steps are fine enough
    if near > safety:
        _change(robot, {"slow_distance": near}, fraction=0.75)


@check(points=1, covers="at-once", needs=("starts",), after=("names",))
@hint("Ask for the present threshold at each command.")
def test_threshold_change(robot: Robot) -> None:
    """A new battery_threshold immediately decides whether the robot stands still."""
    robot.publish_charge(50.0)
    drives = robot.speed_at(2.5) > 0.0  # at any speed
    expect(drives, "With a threshold of 20 percent and a charge of 50, it does not drive.")
    _change(robot, {"battery_threshold": 60})
    expect_speed(robot.speed_at(2.5), 0.0, "After battery_threshold was set to 60, with a charge of 50")


@check(points=3, covers="apply-rate", needs=("starts",), after=("names",))
@hint("add_post_set_parameters_callback(self.apply) in __init__, and in apply: self.timer.timer_period_ns = ...")
@hint("The period is 1e9 / frequency, in whole nanoseconds. A second timer would publish additional commands.")
def test_rate_change(robot: Robot, draw: random.Random) -> None:
    """A new control_frequency raises or lowers the rate of the commands."""
    for frequency in (draw.choice((20.0, 25.0, 50.0)), draw.choice((4.0, 5.0))):
        _change(robot, {"control_frequency": frequency})
        expect_rate(robot.command_rate(1.0), frequency, f"After control_frequency was set to {frequency}")
    uneven_rate = robot.allowed("control_frequency", draw.choice(UNEVEN_RATES))
    slow = robot.allowed("slow_distance", 1.2, up=True)
    request = {"battery_threshold": 25, "control_frequency": uneven_rate, "slow_distance": slow}
    _change(robot, robot.without_read_only(request), fraction=0.75)
    rate, situation = robot.command_rate(4.0), f"After one request for {values_text(request)}"
    expect_rate(rate, uneven_rate, situation, fraction=0.5)
    if robot.time == LOCKSTEP:  # in real time, no rate is exact enough
        message = f"{situation}, it published {rate:.2f} commands per second; it should publish {uneven_rate:.2f}."
        expect(abs(rate - uneven_rate) <= LOCKSTEP_TOLERANCE * uneven_rate, message, fraction=0.5)


@check(
    points=1,
    covers=("apply-rate", "lets-pass", "refused", "max_linear_velocity"),
    needs=("starts",),
    after=("speed_change",),
)
@hint("apply gets the changed parameters: set the timer's period only if control_frequency is one of them.")
@hint("ROS has already checked the ranges, which include their limits: validate judges only the distances.")
def test_undisturbed(robot: Robot) -> None:
    """The commands keep their rate while other parameters are changed repeatedly."""
    before = robot.command_rate()  # other checks test whether this is the correct rate
    expect(before > 0.0, "It publishes no commands.")
    start, change_count = robot.seconds, 40
    for i in range(change_count):
        share = i // 2 / (change_count // 2 - 1)  # how far from one limit to the other
        if i % 2 == 0:
            robot.publish("/scan", scan(2.5))
        name, value = ("battery_threshold", round(100 * share)) if i % 2 else ("max_linear_velocity", share)
        _change(robot, robot.without_read_only({name: robot.allowed(name, value)}), fraction=0.5)
        robot.advance(0.05)
    expect_rate(robot.rate_since(start), before, "While other parameters were changed repeatedly")


@check(points=1, covers="lets-pass", needs=("starts",), after=("names",))
@hint("Accept a request that names no distance, even if it names only rclpy's own use_sim_time.")
def test_passes(robot: Robot, draw: random.Random) -> None:
    """Requests that do not name a distance are accepted."""
    _change(robot, robot.parameters.values("use_sim_time"))  # unchanged, because the harness's clock depends on it
    for name, value in (("battery_threshold", 30), ("max_linear_velocity", 0.4)):
        _change(robot, robot.without_read_only({name: value}))
    expect_answers(
        robot, dialogues(WITHOUT_DISTANCES, other_parameters=ANY_VALUES), draw, tested_answers=(True,), fraction=0.5
    )


@check(
    points=1,
    covers=("lets-pass", "validate", "apply-rate"),
    needs=("starts",),
    after=("contradiction", "rate_change", "passes"),
)
@hint("Ignore a name that you do not know: do not return or break at it, wherever it is in the request.")
@hint("ROS stores the values in the list that validate gets: do not change this list.")
def test_beside_others(robot: Robot, draw: random.Random, workspace: Workspace) -> None:
    """If a request also names use_sim_time, the rest of it is handled as usual, in any order."""
    mixed_dialogues = dialogues(REFUSED, ACCEPTED, WITHOUT_DISTANCES, is_clear=True, names_foreign=True)
    expect_answers(robot, mixed_dialogues, draw, fraction=0.5)
    foreign_values = robot.parameters.values(FOREIGN)
    request = foreign_values | {name: robot.allowed(name, value) for name, value in CONTRADICTION.items()}
    expect(not robot.change(request).accepted, f"It accepted {values_text(request)}.", fraction=0.5)
    for frequency in (draw.choice((20.0, 25.0)), draw.choice((4.0, 5.0))):
        rate: dict[str, parameters.Value] = {"control_frequency": frequency}
        request = {**foreign_values, **rate} if frequency > 10.0 else {**rate, **foreign_values}
        _change(robot, request)
        expect_rate(robot.command_rate(1.0), frequency, f"After {values_text(request)}", fraction=0.5)
    final_value = bench.set_use_sim_time(workspace)
    observation = "After a request for use_sim_time = True and slow_distance = 1.5, use_sim_time is still False"
    expect(final_value is not False, f"{observation}; ROS should store it like any other parameter.", fraction=0.5)


def draw_contradictions(draw: random.Random) -> tuple[float, float]:
    """Draw a safety distance above the default slow distance, and a slow one below the default safety distance."""
    return round(draw.uniform(1.1, 2.5), 2), round(draw.uniform(0.25, 0.45), 2)


def draw_distances(draw: random.Random) -> tuple[float, float, float, float]:
    """Draw a safety and a slow distance that fit, then a safety and a slow distance that contradict these."""
    safety, slow, far, near = ((10 * tenths + draw.randrange(2, 9)) / 100 for tenths in (7, 13, 19, 6))
    return safety, slow, far, near


def _change(robot: Robot, request: Mapping[str, parameters.Value], fraction: float = 0.0) -> None:
    answer = robot.change(request)
    expect(answer.accepted, f"It refused {values_text(request)}: “{answer.reason}”.", fraction=fraction)
