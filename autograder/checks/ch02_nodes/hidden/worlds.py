"""A minute in each of three hidden worlds, judged by temporal logic over the robot's track."""

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
SECONDS = 60.0
RADIUS = 0.18  # m
MIN_PATH = 3.0  # m in a minute: at 0.3 m/s that is ten seconds of driving
WAY = 9.0  # m: half of what a minute at 0.3 m/s allows
STRETCH, MIN_STRETCH = 20.0, 0.5  # s, and m that it drives in each: at 0.3 m/s less than two seconds of driving
REACH = 2.0  # m from its start: right robots come 3 m far in every world
AHEAD = 1.25  # m: it turns for what is within 1 m, and needs some time to turn and to stop
SAFE = "gap > 0.01"  # m between the footprint and the nearest thing
TALKS = ("subscribes_scan", "publishes_cmd_vel")
REACTS = ("forward_when_clear", "turns_when_blocked")
HINTS = (
    "Look at the picture: what did the lidar see at the marked instant, and at which bearing?",
    "Drive the same kind of world in the notebook, with drive(...), and print what control_loop decides.",
)


@check(points=3, covers=("near", "clear", "sector"), needs=TALKS, after=REACTS)
@hint(*HINTS)
def test_room(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a furnished room and touches nothing."""
    _expect_safe_drive(workspace, world_generation.furnished_room(draw), draw, artifacts)


@check(points=3, covers=("near", "clear", "sector"), needs=TALKS, after=REACTS)
@hint(*HINTS)
def test_pillars(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a hall of pillars and touches nothing."""
    _expect_safe_drive(workspace, world_generation.hall_of_pillars(draw), draw, artifacts)


@check(points=3, covers=("near", "clear", "sector"), needs=TALKS, after=REACTS)
@hint(*HINTS)
def test_corridor(workspace: Workspace, draw: random.Random, artifacts: Artifacts) -> None:
    """It drives for a minute in a bent corridor and touches nothing."""
    _expect_safe_drive(workspace, world_generation.bent_corridor(draw), draw, artifacts)


def _expect_safe_drive(workspace: Workspace, world: World, draw: random.Random, artifacts: Artifacts) -> None:
    simulation = Simulation(world, (RobotSpec(radius=RADIUS),), seed=draw.randrange(2**31))
    with AutoHarness(workspace, PACKAGE, EXECUTABLE, publishes=SENSOR_TOPICS, subscribes=COMMAND_TOPICS) as harness:
        recording = drive(harness, simulation, SECONDS).recording
    verdict = temporal.always(SAFE, recording.times.tolist(), {"gap": recording.clearances[:, 0].tolist()})
    rules = {"the gap to the nearest thing, in m, is above 0.01": verdict}
    driven = blindness.path(recording)
    if verdict.violated_at is not None:
        when = verdict.violated_at
        what = _nearest(recording, when)
        sentence = f"It touched {what} at t = {when:.1f} s."
        caption = f"The robot's track in {world.name}. {sentence}"
        artifacts.track("track", recording, caption, mark=when, note=f"touches {what}", rules=rules)
        share = min(when / SECONDS, float(driven[row_at(recording, when)]) / WAY)
        acts = blindness.turns_at_things(recording, AHEAD, until=when)
        raise CheckFailed(sentence, fraction=round(share, 2) if acts else 0.0)
    caption = f"The robot's track in {world.name}: {driven[-1]:.1f} m in {SECONDS:.0f} s, nothing touched."
    artifacts.track("track", recording, caption, rules=rules)
    _expect_drive(recording, driven)


def _expect_drive(recording: Recording, driven: blindness.Floats) -> None:
    """Fail the check if a robot that touched nothing hardly moved, or moved without a look at what is ahead."""
    nothing = "It touched nothing, but"
    expect(driven[-1] >= MIN_PATH, f"{nothing} drove only {driven[-1]:.1f} m in a minute: it hardly moved.")
    for start in np.arange(0.0, SECONDS, STRETCH):
        metres = float(np.diff(np.interp((start, start + STRETCH), recording.times, driven))[0])
        said = f"{nothing} drove only {metres:.1f} m from t = {start:.0f} s to t = {start + STRETCH:.0f} s."
        expect(metres >= MIN_STRETCH, said)
    away = float(np.hypot(*(recording.poses[:, 0, :2] - recording.poses[0, 0, :2]).T).max())
    expect(away >= REACH, f"{nothing} came no further than {away:.1f} m from its start: it drove in circles.")
    turns = blindness.turns_at_things(recording, AHEAD)
    expect(
        turns, f"{nothing} hardly turned where something was within {AHEAD} m ahead: it did not turn for what it saw."
    )


def _nearest(recording: Recording, when: float) -> str:
    return clearance(recording.simulation, state_at(recording, row_at(recording, when))).what
