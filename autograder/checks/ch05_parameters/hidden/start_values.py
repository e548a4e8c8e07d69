"""Checks of the node's behaviour when it is started with values other than its defaults."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

import pytest

from autograder.checking import (
    Artifacts,
    CheckFailed,
    Shared,
    Workspace,
    drive,
    expect,
    group,
    hint,
    temporal,
)
from autograder.checking.drawn_cases import expect_each
from autograder.checking.probes import parameters
from autograder.checks.ch05_parameters.support import bench, contract
from autograder.checks.ch05_parameters.support.answers import allowed_start, expect_start, start_sort_key
from autograder.checks.ch05_parameters.support.drawn_requests import ACCEPTED, REFUSED, Request, starts, values_text
from autograder.checks.ch05_parameters.support.robot import Robot, expect_rate, expect_speed, missing_from, start_error
from sim import Pose, RobotSpec, Simulation, World, box

check = group("start")
START_COUNTS = {REFUSED: 12, ACCEPTED: 4}  # how many starts are drawn, all in one process
RADIUS = 0.18  # m: the robot's radius
DRIVE_SECONDS = 16.0  # s: the length of the drive
STOP_MARGIN = 0.02  # m between where the robot stands and where it should stand


@dataclass(frozen=True)
class ConfiguredRobot:
    """A node that was started with drawn values, and these values."""

    robot: Robot
    values: dict[str, parameters.Value]
    velocity: float
    safety: float
    slow: float
    frequency: float
    threshold: int


def start_numbers(seed: int) -> dict[str, float]:
    """Draw numbers for the five parameters that have limits, in the order of `ConfiguredRobot`."""
    generator = Random(f"{seed}:custom")
    velocity, safety = generator.randrange(40, 80) / 100, generator.randrange(70, 110) / 100
    return {
        "max_linear_velocity": velocity,
        "safety_distance": safety,
        "slow_distance": round(safety + generator.randrange(30, 60) / 100, 2),
        "control_frequency": generator.choice((20.0, 25.0, 50.0)),
        "battery_threshold": generator.randrange(35, 65),
    }


@pytest.fixture(scope="module")
def configured(workspace: Workspace, shared_robot: Shared[Robot], seed: int) -> Iterator[ConfiguredRobot]:
    """A node that was started with drawn values for all six parameters."""
    default_robot = shared_robot.get()
    numbers = start_numbers(seed)
    drawn_numbers = {
        name: default_robot.allowed(name, number, up=name == "slow_distance") for name, number in numbers.items()
    }
    velocity, safety, slow, frequency, threshold = drawn_numbers.values()
    values: dict[str, parameters.Value] = {
        "robot_name": f"Robot{Random(f'{seed}:name').randrange(100, 999)}",
        **drawn_numbers,
    }
    values = parameters.as_declared({**values, "battery_threshold": int(threshold)}, default_robot.initial)
    with Robot(workspace, values) as robot:
        yield ConfiguredRobot(robot, values, velocity, safety, slow, frequency, int(threshold))


@check(
    points=2,
    covers=contract.TABLE_ROWS,
    needs=("starts",),
    after=("names", "types"),
    doc=contract.ARGUMENTS,
)
@hint("declare_parameter applies an override by itself; a set_parameters after it would undo that.")
@hint("ignore_override=True lets the default win over a file: leave it out.")
def test_overrides(configured: ConfiguredRobot) -> None:
    """Started with values from the command line, the node has these values."""
    differences = parameters.differences(configured.robot.parameters.values(*configured.values), configured.values)
    fraction = round(0.8 * (1 - len(differences) / len(configured.values)), 2)
    expect(not differences, f"{'; '.join(differences)}.", fraction=fraction)


@check(points=2, covers="max_linear_velocity", needs=("starts",), after=("overrides",))
@hint("The given method speed asks for max_linear_velocity at each command: leave it so.")
def test_start_speed(configured: ConfiguredRobot) -> None:
    """Where the way is clear, the robot drives at the max_linear_velocity with which the node was started."""
    speed = configured.robot.speed_at(configured.slow + 0.3)
    expect_speed(speed, configured.velocity, f"Started with max_linear_velocity {configured.velocity}")


@check(points=2, covers="control_frequency", needs=("starts",), after=("overrides",))
@hint("create_timer gets a period in seconds: 1.0 / frequency.")
def test_start_rate(configured: ConfiguredRobot) -> None:
    """The node publishes commands at the control_frequency with which it was started."""
    expect_rate(
        configured.robot.command_rate(), configured.frequency, f"Started with control_frequency {configured.frequency}"
    )


@check(points=1, covers="battery_threshold", needs=("starts",), after=("overrides",))
@hint("With a charge below battery_threshold, in percent, the robot stands still.")
def test_start_threshold(configured: ConfiguredRobot) -> None:
    """The robot stands still with a charge below battery_threshold, and drives with a charge above it."""
    situation = f"With a threshold of {configured.threshold} percent and a charge of"
    low, high = configured.threshold - 5, configured.threshold + 5
    configured.robot.publish_charge(low)
    expect_speed(configured.robot.speed_at(3.0), 0.0, f"{situation} {low}")
    configured.robot.publish_charge(high)
    drives = configured.robot.speed_at(3.0) > 0.0  # at any speed
    expect(drives, f"{situation} {high}, it does not drive.")


@check(points=3, covers="safety_distance", needs=("starts",), after=("overrides", "start_speed"))
@hint("Look at the picture: where does the robot stop, and where should it stop?")
@hint("Drive it yourself: drive(..., parameters={'safety_distance': 0.9, 'slow_distance': 1.4}).")
def test_stops(configured: ConfiguredRobot, draw: Random, artifacts: Artifacts) -> None:
    """In the simulator, the robot drives up to a wall, and stops at the safety distance."""
    recording = drive(configured.robot, _hall(draw), DRIVE_SECONDS).recording
    ahead = (recording.simulation.world.bounds[2] - recording.poses[:, 0, 0]).tolist()
    final_distance = ahead[-1]
    sentence = (
        f"With a safety distance of {configured.safety} m, it was {final_distance:.2f} m from the wall at the end."
    )
    verdict = temporal.always(
        "gap > 0", recording.times.tolist(), {"gap": [x - configured.safety + STOP_MARGIN for x in ahead]}
    )
    rules = {f"the distance to the wall, in m, is above {configured.safety - STOP_MARGIN:.2f}": verdict}
    artifacts.track("track", recording, sentence, mark=DRIVE_SECONDS, note=f"{final_distance:.2f} m", rules=rules)
    if verdict.violated_at is not None:
        raise CheckFailed(
            f"The robot came nearer than {configured.safety} m at t = {verdict.violated_at:.1f} s. {sentence}"
        )
    expect(
        final_distance < configured.safety + STOP_MARGIN,
        sentence,
        fraction=0.5 if ahead[0] - final_distance > STOP_MARGIN else 0.0,
    )


@check(points=2, covers=("contradictory-start", "contradiction", "reason", "ranges"), needs=("starts",))
@hint("After declaring, call contradiction(...) with the two values, and raise ValueError if it returns a sentence.")
@hint("Equal distances do not fit, either: the method speed divides by their difference.")
@hint("declare_parameter raises an exception for a value outside a range: let this end the node, too.")
def test_contradictory_start(robot: Robot, workspace: Workspace, draw: Random) -> None:
    """The node does not start if the safety distance is not below the slow distance."""
    distance = robot.allowed("slow_distance", robot.allowed("safety_distance", draw.randrange(40, 90) / 100))
    values = {"safety_distance": robot.allowed("safety_distance", distance + 0.4), "slow_distance": distance}
    error = start_error(workspace, parameters.as_declared(values, robot.initial))
    expect(error is not None, f"Started with {values_text(values)}, the node runs.")
    expect(
        not missing_from(error or "", values),
        f"The node ends, but its error does not name {values_text(values)}.",
        fraction=0.5,
    )
    drawn_starts: list[Request] = []
    for kind, count in START_COUNTS.items():
        expect_each(starts(kind), drawn_starts.append, draw, count=count)
    out_of_range: dict[str, parameters.Value] = {"control_frequency": draw.randrange(55, 90) + 0.5}
    in_range = [allowed_start(robot, start) for start in ((), *drawn_starts)]
    *outcomes, outcome_out_of_range = bench.declare(workspace, [*in_range, out_of_range])
    for start, outcome in sorted(zip(in_range, outcomes, strict=True), key=lambda pair: start_sort_key(pair[0])):
        expect_start(start, outcome)
    observation = f"Started with {values_text(out_of_range)}, declare_configuration raised nothing"
    expect(
        bool(outcome_out_of_range.declaration.raised),
        f"{observation}; it should let ROS refuse values outside 1.0 to 50.0.",
        fraction=0.75,
    )


def _hall(draw: Random) -> Simulation:
    """Return a hall whose east wall is straight ahead of the robot, far beyond any slow distance."""
    world = World.from_segments(
        box(draw.uniform(5.5, 6.5), 4.0).tolist(),
        name="a hall",
        segment_names=["south wall", "east wall", "north wall", "west wall"],
        starts=[Pose(draw.uniform(-0.5, 0.0), draw.uniform(-0.5, 0.5), 0.0)],
    )
    return Simulation(world, (RobotSpec(radius=RADIUS),), seed=draw.randrange(2**31))
