"""Encodes a recording for the player: at most 300 kB of text, with rounded, delta-coded and compressed numbers.

Each table is rounded to whole steps, and each row is replaced by its difference from the previous one. Then the four
bytes of each number are put in separate planes, deflated and encoded as base64. Neighbouring rows hardly differ, so
most of these bytes are 0.
"""

from __future__ import annotations

import base64
import json
import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from sim.lidar import LidarSpec
from sim.log import Line, shorten
from sim.recording import Recording
from sim.robot import RobotSpec
from sim.state import Event
from sim.view.figures import heading
from sim.view.shapes import (
    Moment,
    body_outline,
    is_full_turn,
    margin_of,
    moment_of,
    movers_at,
    nose_outline,
    outlines,
)
from sim.world import World

MAX_BYTES = 300_000
MAX_LOG_BYTES = 60_000  # the part of `MAX_BYTES` that the output of the programs may use
LADDER = ((3000, 360), (3000, 120), (1500, 60), (750, 30), (400, 10))
"""Pairs of the maximum numbers of rows and of beams in a scan. The first that makes the text short enough is used."""

CENTIMETRE, MILLI = 0.01, 0.001
NO_RETURN, NO_READING = -1.0, 0.0
"""The codes for a range of +inf, and for a range that is invalid or too short to be measured."""


@dataclass(frozen=True)
class Margin:
    """How far a rule is from being broken, over time.

    Attributes:
        rule: the text of the rule, with the unit of its values.
        times: the times in seconds, in ascending order.
        values: a value for each time, 0 or less if the rule is broken.
        broken_at: the first time in seconds at which the rule is broken, or None.
    """

    rule: str
    times: Sequence[float]
    values: Sequence[float]
    broken_at: float | None


def encode(
    recording: Recording, alt: str, margins: Sequence[Margin] = (), *, mark: float | None = None, note: str = ""
) -> str:
    """Return the JSON of a run for the player. The same run gives the same text.

    Args:
        recording: the run.
        alt: the alternative text.
        margins: the rules for the run.
        mark: the time in seconds of the instant that the player shows first. If it is None, that is the first instant
            at which a rule was broken, or the end of the run.
        note: the text for the instant.

    Raises:
        ValueError: `mark` is not finite.
    """
    broken_times = [margin.broken_at for margin in margins if margin.broken_at is not None]
    mark = min(broken_times, default=None) if mark is None else mark
    moment = moment_of(recording, list(range(len(recording.simulation.robots))), mark, note)
    title, summary = heading(recording)
    text = ""
    for max_rows, max_beams in LADDER:
        data = {
            "alt": alt,
            "title": title,
            "summary": summary,
            "moment": None if moment is None else _encode_moment(moment),
            "world": encode_world(recording.simulation.world),
            "margins": [_encode_margin(margin, max_rows) for margin in margins],
            "said": _encode_log(recording.log_lines),
            **_encode_run(recording, max_rows, max_beams),
        }
        # "</" would end the script element; "\\u003c" is the same character to JSON.
        text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
        if len(text) <= MAX_BYTES:
            break
    return text


def pack(values: npt.ArrayLike, step: float) -> dict[str, Any]:
    """Return a table of numbers, (rows, columns) or (rows,), in whole steps, delta-coded and compressed."""
    table = np.atleast_2d(np.asarray(values, dtype=np.float64))
    table = table.T if np.ndim(values) == 1 else table
    steps = np.round(table / step).astype(np.int64)
    differences = np.diff(steps, axis=0, prepend=np.zeros((1, steps.shape[1]), dtype=np.int64))
    zigzag = np.where(differences < 0, -2 * differences - 1, 2 * differences).astype("<u4")
    planes = zigzag.reshape(-1, 1).view(np.uint8).T.tobytes()
    return {"columns": steps.shape[1], "step": step, "data": _deflate(planes)}


def _deflate(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 9)).decode("ascii")


def _encode_moment(moment: Moment) -> dict[str, Any]:
    near = (moment.near.x, moment.near.y)
    return {
        "time": round(moment.time, 3),
        "at": [round(moment.x, 3), round(moment.y, 3)],
        "near": [round(number, 3) for number in near] if all(map(math.isfinite, near)) else None,
        "words": moment.words,
        "spot": [round(number, 3) for number in moment.spot],
        "marked": moment.marked,
    }


def encode_world(world: World) -> dict[str, Any]:
    """Return a world for the page. Lengths are metres."""
    room, solid = outlines(world)
    left, low, right, high = world.bounds
    margin = margin_of(world)
    return {
        "name": world.name,
        "bounds": [round(side, 3) for side in (left - margin, low - margin, right + margin, high + margin)],
        "inside": [round(side, 3) for side in (left, low, right, high)],
        "room": pack(room, MILLI),
        "solid": [pack(loop, MILLI) for loop in solid],
        "walls": pack(world.segments.reshape(-1, 4), MILLI),
        "pillars": pack(world.circles.reshape(-1, 3), MILLI),
        "goals": [[round(number, 3) for number in (goal.x, goal.y, goal.radius)] for goal in world.goals],
        "starts": [[round(number, 3) for number in (place.x, place.y, place.theta)] for place in world.starts],
        "movers": [mover.radius for mover in world.movers],
        "routes": [np.round([*mover.path, *mover.path[: int(mover.loop)]], 3).tolist() for mover in world.movers],
    }


def _encode_run(recording: Recording, max_rows: int, max_beams: int) -> dict[str, Any]:
    rows, simulation = _selected_rows(len(recording), max_rows), recording.simulation
    paths = [np.ravel(movers_at(simulation, time)) for time in recording.times_ns[rows].tolist()]
    return {
        "times": pack(recording.times[rows], MILLI),
        "paths": pack(paths, MILLI) if simulation.world.movers else None,
        "robots": [
            {
                **encode_shape(spec),
                "poses": pack(_unwrap_angles(recording.poses[rows, index]), MILLI),
                "velocities": pack(recording.velocities[rows, index], MILLI),
                "commands": _encode_commands(recording, index, rows),
                "gaps": pack(np.nan_to_num(recording.clearances[rows, index], posinf=1e3, neginf=0.0), MILLI),
                "scans": _encode_scans(recording, index, max_rows, max_beams),
            }
            for index, spec in enumerate(simulation.robots)
        ],
        "collisions": [encode_collision(event) for event in recording.events[:max_rows] if event.kind == "collision"],
    }


def encode_shape(spec: RobotSpec) -> dict[str, Any]:
    """Return the name and the outlines of a robot, in metres in its frame."""
    body, nose = body_outline(spec), nose_outline(spec)
    return {"name": spec.name, "body": np.round(body, 3).tolist(), "nose": np.round(nose, 3).tolist()}


def encode_collision(event: Event) -> list[Any]:
    """Return the time in seconds of a collision, its place in metres, the obstacle, and the robot's name."""
    return [round(event.time_ns / 1e9, 3), round(event.x, 3), round(event.y, 3), event.what, event.robot]


def encode_lidar(lidar: LidarSpec, beam_step: int) -> dict[str, Any]:
    """Return the geometry of a lidar of which every `beam_step`-th beam is shown, in metres and radians."""
    return {
        "mount": [round(number, 4) for number in (lidar.mount.x, lidar.mount.y, lidar.mount.theta)],
        "first": lidar.angle_min,
        "turn": lidar.angle_increment * beam_step,
        "reach": lidar.range_max,
        "full": is_full_turn(lidar),
    }


def beam_step_of(lidar: LidarSpec, max_beams: int) -> int:
    """Return the distance between two shown beams, so that at most `max_beams` are shown."""
    return max(1, math.ceil(lidar.beams / max_beams))


def range_codes(ranges: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Return ranges in metres with `NO_RETURN` and `NO_READING` instead of numbers that are not finite."""
    values = ranges.astype(np.float64)
    return np.where(values == math.inf, NO_RETURN, np.where(np.isfinite(values), values, NO_READING))


def _selected_rows(count: int, limit: int) -> npt.NDArray[np.int64]:
    """Return the indices of all `count` rows or, if there are more than `limit`, of `limit` evenly spaced ones."""
    return np.unique(np.linspace(0, count - 1, min(count, limit)).round().astype(np.int64))


def _unwrap_angles(poses: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return poses whose angles have no jumps, so that the player can interpolate between them."""
    return np.column_stack([poses[:, :2], np.unwrap(poses[:, 2])])


def _encode_commands(recording: Recording, index: int, rows: npt.NDArray[np.int64]) -> dict[str, Any] | None:
    """Return the latest command at each row, from the first command on, or None if there is none."""
    has_command = ~np.isnan(recording.commands[:, index, 0])
    if not has_command.any():
        return None
    newest_rows = np.maximum.accumulate(np.where(has_command, np.arange(len(recording)), 0))
    latest_commands = np.nan_to_num(recording.commands[newest_rows, index], posinf=0.0, neginf=0.0)
    first = float(recording.times[int(np.argmax(has_command))])
    return {"first": round(first, 3), **pack(latest_commands[rows], MILLI)}


def _encode_scans(recording: Recording, index: int, max_rows: int, max_beams: int) -> dict[str, Any] | None:
    lidar, log = recording.simulation.robots[index].lidar, recording.scans[index]
    if lidar is None or not len(log.rows):
        return None
    numbers, beam_step = _selected_rows(len(log.rows), max_rows), beam_step_of(lidar, max_beams)
    return {
        "times": pack(recording.times[log.rows[numbers]], MILLI),
        "poses": pack(recording.poses[log.rows[numbers], index], MILLI),
        **encode_lidar(lidar, beam_step),
        "ranges": pack(range_codes(log.ranges[numbers, ::beam_step]), CENTIMETRE),
    }


def _encode_log(lines: tuple[Line, ...]) -> dict[str, Any] | None:
    """Return the output of the programs, shortened to `MAX_LOG_BYTES`; None if there is none."""
    limit = len(lines)
    while selected_lines := shorten(lines, limit):
        data = _deflate(json.dumps([text for _, text in selected_lines]).encode())
        if len(data) <= MAX_LOG_BYTES:
            return {"times": pack([seconds for seconds, _ in selected_lines], MILLI), "texts": data}
        limit //= 2
    return None


def _encode_margin(margin: Margin, max_rows: int) -> dict[str, Any]:
    rows = _selected_rows(len(margin.times), max_rows)
    values = np.nan_to_num(np.asarray(margin.values, dtype=np.float64)[rows], posinf=1e3, neginf=-1e3)
    return {
        "rule": margin.rule,
        "times": pack(np.asarray(margin.times, dtype=np.float64)[rows], MILLI),
        "values": pack(values, MILLI),
        "broken": None if margin.broken_at is None else round(margin.broken_at, 3),
    }
