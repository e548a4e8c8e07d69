"""The data of a live view: what the page gets for an instant, and what does not change."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from sim import LDS_01, Command, Recording, RobotSpec, Simulation, World, load_world
from sim.view import DARK, LIGHT
from sim.view.live_data import MAX_BEAMS, MAX_COLLISIONS, describe, frame_data
from sim.view.run_data import NO_READING, NO_RETURN
from sim.view.session import TRAIL, Session

ROOT = Path(__file__).resolve().parents[3]
SECOND = 1_000_000_000


def numbers(data: bytes) -> npt.NDArray[np.float32]:
    return np.frombuffer(data, dtype="<f4")


def session_of(world: World, *robots: RobotSpec, seconds: float = 2.0) -> Session:
    session = Session(Simulation(world, robots or (RobotSpec(),)), lambda scan: Command(0.4, 0.3))
    session.advance(round(seconds * SECOND))
    return session


def test_a_frame_contains_the_state_of_each_robot(world: World) -> None:
    session = session_of(world, RobotSpec(name="one"), RobotSpec(name="two"))
    frame = frame_data(session, SECOND)
    assert (frame["time"], frame["end"]) == (1.0, 2.0)
    state = session.at(SECOND).state
    for robot, expected in zip(frame["robots"], state.robots, strict=True):
        assert robot["pose"] == [expected.pose.x, expected.pose.y, expected.pose.theta]
        assert robot["velocity"] == [expected.velocity.linear, expected.velocity.angular]
        assert 0.0 < robot["gap"] < 12.0
        assert not robot["blocked"]
    assert [robot["command"] for robot in frame["robots"]] == [[0.4, 0.3], None]
    assert frame["movers"] == [(x, y) for x, y, _ in session.simulation.movers_at(SECOND)]


def test_a_frame_contains_the_newest_scan_and_the_pose_at_which_it_was_measured(world: World) -> None:
    session = session_of(world)
    frame = frame_data(session, SECOND + SECOND // 10)
    newest = session.at(SECOND).scans[0]
    assert newest is not None
    scan, pose = newest
    decoded = numbers(frame["robots"][0]["scan"]["ranges"])
    assert frame["robots"][0]["scan"]["pose"] == [pose.x, pose.y, pose.theta]
    assert decoded == pytest.approx(np.where(scan.ranges == math.inf, NO_RETURN, scan.ranges))


def test_lost_beams_have_a_code_and_a_fine_lidar_has_fewer_beams(world: World) -> None:
    lidar = replace(LDS_01, beams=3 * MAX_BEAMS, angle_increment=LDS_01.angle_increment / 3, dropout=0.5)
    session = session_of(world, RobotSpec(lidar=lidar))
    decoded = numbers(frame_data(session, SECOND)["robots"][0]["scan"]["ranges"])
    assert len(decoded) == MAX_BEAMS
    assert (decoded == NO_READING).sum() > 20
    described = describe(session, LIGHT, names=False)["robots"][0]["scans"]
    assert described["turn"] == pytest.approx(3 * lidar.angle_increment)
    assert (described["reach"], described["full"]) == (lidar.range_max, True)


def test_a_robot_without_a_lidar_has_no_scan(world: World) -> None:
    session = session_of(world, RobotSpec(lidar=None))
    assert frame_data(session, SECOND)["robots"][0]["scan"] is None
    assert describe(session, LIGHT, names=False)["robots"][0]["scans"] is None


def test_a_track_begins_at_the_start_and_has_a_limited_number_of_points(world: World) -> None:
    session = session_of(world, seconds=TRAIL * 0.02 * 3)
    for seconds, count in ((0.0, 1), (1.0, 51), (TRAIL * 0.02 * 3, TRAIL)):
        track = numbers(frame_data(session, round(seconds * SECOND))["robots"][0]["track"]).reshape(-1, 2)
        assert track[0].tolist() == pytest.approx([world.starts[0].x, world.starts[0].y])
        assert 0.6 * count < len(track) <= count
    earlier = frame_data(session, SECOND)["robots"][0]
    assert numbers(earlier["track"])[-2:].tolist() == pytest.approx(earlier["pose"][:2])


def test_a_frame_contains_the_newest_collisions_until_its_time(recording: Recording) -> None:
    session = Session(recording.simulation, lambda scan: Command(0.4, 0.3))
    session.advance(8 * SECOND)
    events = session.collisions(8 * SECOND)
    assert events
    (time, x, y, what, robot), *_ = frame_data(session, 8 * SECOND)["collisions"]
    assert (time, what, robot) == (pytest.approx(events[0].time_ns / 1e9, abs=1e-3), events[0].what, "one")
    assert (x, y) == (pytest.approx(events[0].x, abs=1e-3), pytest.approx(events[0].y, abs=1e-3))
    assert frame_data(session, events[0].time_ns - 1)["collisions"] == []
    session._collisions = events[:1] * 3 * MAX_COLLISIONS
    assert len(frame_data(session, 8 * SECOND)["collisions"]) == MAX_COLLISIONS
    session.reset()
    assert session.collisions(8 * SECOND) == []


def test_a_frame_is_small_and_the_rest_is_json(world: World) -> None:
    session = session_of(world, seconds=60.0)
    data: Any = frame_data(session, 60 * SECOND)
    size = len(json.dumps(data, default=lambda part: part.decode("latin-1"), ensure_ascii=False, allow_nan=False))
    assert size < 20_000
    json.dumps(describe(session, DARK, names=True), allow_nan=False)


def test_an_empty_world_has_no_gap() -> None:
    session = session_of(World())
    assert json.loads(json.dumps(frame_data(session, SECOND)["robots"][0]["gap"])) == 1000.0


def test_the_description_has_the_colours_of_the_theme_and_names_if_wanted() -> None:
    session = session_of(load_world(ROOT / "assets" / "worlds" / "lab.yaml"))
    named, unnamed = (describe(session, DARK, names=names) for names in (True, False))
    assert named["colours"] == DARK.named
    assert {"table", "dock", "north wall", "slanted wall"} <= {name["text"] for name in named["names"]}
    assert unnamed["names"] == []
    assert (named["title"], named["summary"]) == ("The lab", "12.0 × 8.0 m")  # noqa: RUF001
    assert (named["paced"], named["drivable"], named["releasable"]) == (True, True, True)
