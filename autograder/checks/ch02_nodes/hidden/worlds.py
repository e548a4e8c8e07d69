"""Checks that apply temporal logic to the robot's track on a drive of one minute in each of three hidden worlds."""

from __future__ import annotations

import random

import numpy as np

from autograder.checking import (
    COMMAND_TOPICS,
    SENSOR_TOPICS,
    Artifacts,
    AutoHarness,
    CheckFailed,
    Workspace,
    drive,
    expect,
    group,
    hint,
    temporal,
)
from autograder.checks.ch02_nodes.hidden import blindness, world_generation
from autograder.checks.ch02_nodes.support.contract import EXECUTABLE, PACKAGE
from sim import Recording, RobotSpec, Simulation, World, clearance
from sim.rows import row_at, state_at

check = group("worlds")
DRIVE_SECONDS = 60.0  # s: the length of each drive
RADIUS = 0.18  # m: the robot's radius
MIN_PATH = 3.0  # m in a minute: at 0.3 m/s that is ten seconds of driving
LONG_PATH = 9.0  # m: half the distance that a robot at 0.3 m/s drives in a minute
# The length of a stretch in s, and the distance in m that the robot must drive in each: less than 2 s at 0.3 m/s.
STRETCH, MIN_STRETCH = 20.0, 0.5
REACH = 2.0  # m from the start that a robot must reach: correct robots get 3 m away in every world
AHEAD = 1.25  # m: a robot turns for obstacles within 1 m, and needs some time to stop and to turn
SAFE = "gap > 0.01"  # gap: m between the robot's footprint and the nearest thing
TOPIC_CHECKS = ("subscribes_scan", "publishes_cmd_vel")
REACTION_CHECKS = ("forward_when_clear", "turns_when_blocked")
HINTS = (
    "Look at the picture: what did the lidar see at the marked point, and at which bearing?",
    "Drive in a similar world with drive(...) in the notebook, and print what control_loop decides.",
)


@check(points=3, covers=("near", "clear", "sector"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint(*HINTS)
def test_room(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a furnished room and touches nothing."""
    _expect_safe_drive(workspace, world_generation.furnished_room(draw), draw, artifacts)


@check(points=3, covers=("near", "clear", "sector"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint(*HINTS)
def test_pillars(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a hall of pillars and touches nothing."""
    _expect_safe_drive(workspace, world_generation.hall_of_pillars(draw), draw, artifacts)


@check(points=3, covers=("near", "clear", "sector"), needs=TOPIC_CHECKS, after=REACTION_CHECKS)
@hint(*HINTS)
def test_corridor(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a bent corridor and touches nothing."""
    _expect_safe_drive(workspace, world_generation.bent_corridor(draw), draw, artifacts)


def _expect_safe_drive(workspace: Workspace, world: World, draw: random.Random, artifacts: Artifacts) -> None:
    simulation = Simulation(world, (RobotSpec(radius=RADIUS),), seed=draw.randrange(2**31))
    with AutoHarness(workspace, PACKAGE, EXECUTABLE, publishes=SENSOR_TOPICS, subscribes=COMMAND_TOPICS) as harness:
        recording = drive(harness, simulation, DRIVE_SECONDS).recording
    verdict = temporal.always(SAFE, recording.times.tolist(), {"gap": recording.clearances[:, 0].tolist()})
    rules = {"the gap to the nearest thing, in m, is above 0.01": verdict}
    distances = blindness.driven_distances(recording)
    if verdict.violated_at is not None:
        seconds = verdict.violated_at
        obstacle = _nearest_name(recording, seconds)
        sentence = f"It touched {obstacle} at t = {seconds:.1f} s."
        caption = f"The robot's track in {world.name}. {sentence}"
        artifacts.track("track", recording, caption, mark=seconds, note=f"touches {obstacle}", rules=rules)
        share = min(seconds / DRIVE_SECONDS, float(distances[row_at(recording, seconds)]) / LONG_PATH)
        reacts = blindness.turns_at_obstacles(recording, AHEAD, until=seconds)
        raise CheckFailed(sentence, fraction=round(share, 2) if reacts else 0.0)
    sentence = f"It drove {distances[-1]:.1f} m in {DRIVE_SECONDS:.0f} s and touched nothing."
    caption = f"The robot's track in {world.name}. {sentence}"
    artifacts.track("track", recording, caption, rules=rules)
    _expect_drive(recording, distances)


def _expect_drive(recording: Recording, distances: blindness.Floats) -> None:
    """Fail the check if a robot that touched nothing hardly moved, or moved without reacting to obstacles ahead."""
    prefix = "It touched nothing, but"
    expect(distances[-1] >= MIN_PATH, f"{prefix} drove only {distances[-1]:.1f} m in a minute: it hardly moved.")
    for start in np.arange(0.0, DRIVE_SECONDS, STRETCH):
        driven_distance = float(np.diff(np.interp((start, start + STRETCH), recording.times, distances))[0])
        message = f"{prefix} drove only {driven_distance:.1f} m from t = {start:.0f} s to t = {start + STRETCH:.0f} s."
        expect(driven_distance >= MIN_STRETCH, message)
    farthest_distance = float(np.hypot(*(recording.poses[:, 0, :2] - recording.poses[0, 0, :2]).T).max())
    message = f"{prefix} went no further than {farthest_distance:.1f} m from its start: it drove in circles."
    expect(farthest_distance >= REACH, message)
    reacts = blindness.turns_at_obstacles(recording, AHEAD)
    expect(
        reacts,
        f"{prefix} it did not turn mainly where something was within {AHEAD} m ahead: it did not react to its lidar.",
    )


def _nearest_name(recording: Recording, seconds: float) -> str:
    return clearance(recording.simulation, state_at(recording, row_at(recording, seconds))).name
