"""A run is encoded for the player: rounded, small, and decoded to the same values."""

from __future__ import annotations

import base64
import json
import math
import random
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from sim import Command, Recording, RobotSpec, Simulation, World, load_world, run
from sim.log import OMISSION
from sim.view import Margin, encode
from sim.view.run_data import MAX_BYTES, MAX_LOG_BYTES, NO_RETURN, pack

ROOT = Path(__file__).resolve().parents[3]


def unpack(packed: dict[str, Any]) -> npt.NDArray[np.float64]:
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), dtype=np.uint8)
    codes = np.ascontiguousarray(planes.reshape(4, -1).T).view("<u4").astype(np.int64).reshape(-1, packed["columns"])
    decoded: npt.NDArray[np.float64] = (
        np.where(codes % 2, -(codes + 1) // 2, codes // 2).cumsum(axis=0) * packed["step"]
    )
    return decoded


def test_a_decoded_table_is_rounded_to_its_steps() -> None:
    table = np.random.default_rng(7).normal(scale=40.0, size=(50, 3))
    assert unpack(pack(table, 0.001)) == pytest.approx(table, abs=0.00051)
    assert unpack(pack([2.5, -1.0], 0.5)).tolist() == [[2.5], [-1.0]]
    assert unpack(pack(np.empty((0, 4)), 0.001)).shape == (0, 4)


def test_a_run_keeps_its_poses_scans_commands_and_collisions(recording: Recording) -> None:
    margin = Margin("the gap, in m", (0.0, 1.0), (0.5, -math.inf), 1.0)
    data = json.loads(encode(recording, "what it shows", [margin]))
    robot = data["robots"][0]
    assert data["alt"] == "what it shows"
    assert unpack(data["times"])[:, 0] == pytest.approx(recording.times, abs=0.00051)
    assert unpack(robot["poses"])[:, :2] == pytest.approx(recording.poses[:, 0, :2], abs=0.00051)
    assert unpack(robot["commands"])[-1].tolist() == pytest.approx([0.4, 0.3])
    ranges, decoded = recording.scans[0].ranges, unpack(robot["scans"]["ranges"])
    assert decoded[np.isfinite(ranges)] == pytest.approx(ranges[np.isfinite(ranges)], abs=0.0051)
    assert (decoded[ranges == math.inf] == NO_RETURN).all()
    assert [time for time, *_ in data["collisions"]] == [
        pytest.approx(event.time_ns / 1e9, abs=0.001) for event in recording.events if event.kind == "collision"
    ]
    (encoded,) = data["margins"]
    assert (encoded["broken"], unpack(encoded["values"])[:, 0].tolist()) == (1.0, [0.5, -1000.0])


def test_a_run_opens_at_its_mark_or_else_where_a_rule_broke(recording: Recording) -> None:
    def moment(**options: Any) -> Any:
        margins = [Margin("far", (0.0,), (1.0,), None), Margin("near", (0.0, 2.0), (1.0, -1.0), 2.0)]
        return json.loads(encode(recording, "", margins, **options))["moment"]

    assert (moment()["time"], moment()["words"], moment()["marked"]) == (2.0, "t = 2.0 s", True)
    assert (moment(mark=1.0, note="here")["time"], moment(mark=1.0, note="here")["words"]) == (1.0, "t = 1.0 s\nhere")
    assert json.loads(encode(recording, ""))["moment"] is None  # robots that collide have no closest place


def test_a_run_without_a_mark_shows_its_closest_place(world: World) -> None:
    safe = run(Simulation(world), lambda state, scans: Command(0.2, 0.0), 4.0)
    data = json.loads(encode(safe, ""))
    gap = float(safe.clearances[:, 0].min())
    assert data["moment"]["words"] == f"{gap:.2f} m"
    assert not data["moment"]["marked"]
    (x, y), (near_x, near_y) = data["moment"]["at"], data["moment"]["near"]
    assert math.hypot(x - near_x, y - near_y) == pytest.approx(gap + safe.simulation.robots[0].radius, abs=0.002)
    assert data["title"] == "The lab"
    assert "never nearer than" in data["summary"]


def test_the_data_of_a_minute_are_small_and_those_of_a_fleet_are_thinned_out() -> None:
    world = load_world(ROOT / "assets" / "worlds" / "lab.yaml")
    minute = run(Simulation(world), lambda state, scans: Command(0.3, 0.2), 60.0)
    assert len(encode(minute, "")) < MAX_BYTES / 3
    fleet = tuple(RobotSpec(name=f"robot{number}") for number in range(6))
    commands = {spec.name: Command(0.3, 0.2) for spec in fleet}
    busy = run(Simulation(World.from_segments(world.segments.tolist()), fleet), lambda state, scans: commands, 60.0)
    text = encode(busy, "")
    assert len(text) <= MAX_BYTES
    assert unpack(json.loads(text)["robots"][0]["scans"]["ranges"]).shape[1] < 360


def test_a_name_cannot_end_the_script() -> None:
    markup = "</script><script>alert(1)</script>"
    text = encode(run(Simulation(World(name=markup)), lambda state, scans: None, 0.5), markup)
    assert "<" not in text
    assert json.loads(text)["world"]["name"] == json.loads(text)["alt"] == markup


def decoded_output(text: str) -> list[tuple[float, str]]:
    data = json.loads(text)["said"]
    texts = json.loads(zlib.decompress(base64.b64decode(data["texts"])))
    return list(zip(unpack(data["times"])[:, 0].tolist(), texts, strict=True))


def test_output_of_programs_is_decoded_with_its_times(recording: Recording) -> None:
    markup = "</script><script>alert(1)</script>"
    text = encode(replace(recording, log_lines=((0.1, "near"), (1.5, markup))), "")
    output = decoded_output(text)
    assert [time for time, _ in output] == pytest.approx([0.1, 1.5])
    assert [line for _, line in output] == ["near", markup]
    assert "<" not in text
    assert json.loads(encode(recording, ""))["said"] is None


def test_a_flood_of_lines_that_cannot_be_compressed_is_bounded(recording: Recording) -> None:
    draw = random.Random(1)
    flood = tuple((0.001 * n, "".join(chr(draw.randrange(0x4E00, 0x9FFF)) for _ in range(300))) for n in range(2001))
    text = encode(replace(recording, log_lines=flood), "")
    assert len(json.loads(text)["said"]["texts"]) <= MAX_LOG_BYTES
    assert len(text) <= MAX_BYTES
    assert (decoded_output(text)[0][1], decoded_output(text)[-1][1]) == (flood[0][1], flood[-1][1])
    assert [line for _, line in decoded_output(text)].count(OMISSION) == 1
