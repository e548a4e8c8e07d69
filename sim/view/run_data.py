"""A recording as the text that the player reads: numbers rounded, delta-coded and compressed, 300 kB at most.

Tables are packed one by one: rounded to whole steps, each row less the one before, the four bytes of each number
apart, deflated, base64. Neighbours hardly differ, so that most of these bytes are 0.
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

from sim.log import Line, shorten
from sim.recording import Recording
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
MAX_LOG_BYTES = 60_000  # of them for what the programs wrote
LADDER = ((3000, 360), (3000, 120), (1500, 60), (750, 30), (400, 10))
"""The most rows and the most beams of a scan; the first pair whose text is short enough is taken, or the last one."""

CENTIMETRE, MILLI = 0.01, 0.001
NO_RETURN, NO_READING = -1.0, 0.0
"""What stands for a range of +inf, and for one that is invalid or too near to be measured."""


@dataclass(frozen=True)
class Margin:
    """How far a rule was from being broken, in time.

    Attributes:
        rule: the rule in words, with the unit of its values.
        times: seconds, rising.
        values: one a time; 0 or less where the rule does not hold.
        broken_at: the first time, in seconds, at which it does not hold; None if it always does.
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
        alt: the sentence that stands for the run where it cannot be seen.
        margins: the rules that it was judged by.
        mark: the instant, in seconds, that the player shows first; the first one at which a rule broke if None, or the
            end of the run if none broke.
        note: what is said of the instant.

    Raises:
        ValueError: `mark` is not finite.
    """
    broken = [margin.broken_at for margin in margins if margin.broken_at is not None]
    mark = min(broken, default=None) if mark is None else mark
    moment = moment_of(recording, list(range(len(recording.simulation.robots))), mark, note)
    title, summary = heading(recording)
    text = ""
    for most_rows, most_beams in LADDER:
        data = {
            "alt": alt,
            "title": title,
            "summary": summary,
            "moment": None if moment is None else _moment(moment),
            "world": _world(recording.simulation.world),
            "margins": [_margin(margin, most_rows) for margin in margins],
            "said": _said(recording.log_lines),
            **_run(recording, most_rows, most_beams),
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
    whole = np.round(table / step).astype(np.int64)
    change = np.diff(whole, axis=0, prepend=np.zeros((1, whole.shape[1]), dtype=np.int64))
    zigzag = np.where(change < 0, -2 * change - 1, 2 * change).astype("<u4")
    planes = zigzag.reshape(-1, 1).view(np.uint8).T.tobytes()
    return {"columns": whole.shape[1], "step": step, "data": _deflated(planes)}


def _deflated(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 9)).decode("ascii")


def _moment(moment: Moment) -> dict[str, Any]:
    near = (moment.near.x, moment.near.y)
    return {
        "time": round(moment.time, 3),
        "at": [round(moment.x, 3), round(moment.y, 3)],
        "near": [round(number, 3) for number in near] if all(map(math.isfinite, near)) else None,
        "words": moment.words,
        "spot": [round(number, 3) for number in moment.spot],
        "marked": moment.marked,
    }


def _world(world: World) -> dict[str, Any]:
    room, solid = outlines(world)
    left, low, right, high = world.bounds
    edge = margin_of(world)
    return {
        "name": world.name,
        "bounds": [round(side, 3) for side in (left - edge, low - edge, right + edge, high + edge)],
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


def _run(recording: Recording, most_rows: int, most_beams: int) -> dict[str, Any]:
    rows, simulation = _thinned(len(recording), most_rows), recording.simulation
    paths = [np.ravel(movers_at(simulation, time)) for time in recording.times_ns[rows].tolist()]
    return {
        "times": pack(recording.times[rows], MILLI),
        "paths": pack(paths, MILLI) if simulation.world.movers else None,
        "robots": [
            {
                "name": spec.name,
                "body": np.round(body_outline(spec), 3).tolist(),
                "nose": np.round(nose_outline(spec), 3).tolist(),
                "poses": pack(_unwound(recording.poses[rows, index]), MILLI),
                "velocities": pack(recording.velocities[rows, index], MILLI),
                "commands": _commands(recording, index, rows),
                "gaps": pack(np.nan_to_num(recording.clearances[rows, index], posinf=1e3, neginf=0.0), MILLI),
                "scans": _scans(recording, index, most_rows, most_beams),
            }
            for index, spec in enumerate(simulation.robots)
        ],
        "collisions": [
            [round(event.time_ns / 1e9, 3), round(event.x, 3), round(event.y, 3), event.what, event.robot]
            for event in recording.events[:most_rows]
            if event.kind == "collision"
        ],
    }


def _thinned(count: int, most: int) -> npt.NDArray[np.int64]:
    """Return the numbers of `count` rows, or of `most` among them: the eye sees no difference."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def _unwound(poses: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return poses whose angle does not leap, so that the player may draw what lies between two of them."""
    return np.column_stack([poses[:, :2], np.unwrap(poses[:, 2])])


def _commands(recording: Recording, index: int, rows: npt.NDArray[np.int64]) -> dict[str, Any] | None:
    """Return the newest command at each row, from the first one on; None without any."""
    given = ~np.isnan(recording.commands[:, index, 0])
    if not given.any():
        return None
    newest = np.maximum.accumulate(np.where(given, np.arange(len(recording)), 0))
    held = np.nan_to_num(recording.commands[newest, index], posinf=0.0, neginf=0.0)
    first = float(recording.times[int(np.argmax(given))])
    return {"first": round(first, 3), **pack(held[rows], MILLI)}


def _scans(recording: Recording, index: int, most_rows: int, most_beams: int) -> dict[str, Any] | None:
    lidar, log = recording.simulation.robots[index].lidar, recording.scans[index]
    if lidar is None or not len(log.rows):
        return None
    numbers, keep = _thinned(len(log.rows), most_rows), max(1, math.ceil(lidar.beams / most_beams))
    ranges = log.ranges[numbers, ::keep].astype(np.float64)
    shown = np.where(ranges == math.inf, NO_RETURN, np.where(np.isfinite(ranges), ranges, NO_READING))
    return {
        "times": pack(recording.times[log.rows[numbers]], MILLI),
        "poses": pack(recording.poses[log.rows[numbers], index], MILLI),
        "mount": [round(number, 4) for number in (lidar.mount.x, lidar.mount.y, lidar.mount.theta)],
        "first": lidar.angle_min,
        "turn": lidar.angle_increment * keep,
        "reach": lidar.range_max,
        "full": is_full_turn(lidar),
        "ranges": pack(shown, CENTIMETRE),
    }


def _said(lines: tuple[Line, ...]) -> dict[str, Any] | None:
    """Return what the programs wrote, or as much as there is room for; None if they wrote nothing."""
    most = len(lines)
    while shown := shorten(lines, most):
        data = _deflated(json.dumps([text for _, text in shown]).encode())
        if len(data) <= MAX_LOG_BYTES:
            return {"times": pack([seconds for seconds, _ in shown], MILLI), "texts": data}
        most //= 2
    return None


def _margin(margin: Margin, most_rows: int) -> dict[str, Any]:
    rows = _thinned(len(margin.times), most_rows)
    values = np.nan_to_num(np.asarray(margin.values, dtype=np.float64)[rows], posinf=1e3, neginf=-1e3)
    return {
        "rule": margin.rule,
        "times": pack(np.asarray(margin.times, dtype=np.float64)[rows], MILLI),
        "values": pack(values, MILLI),
        "broken": None if margin.broken_at is None else round(margin.broken_at, 3),
    }
