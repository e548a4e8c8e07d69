"""One HTML file that plays a run: the world as SVG, the robots' poses and scans as numbers, a few lines of script.

It loads nothing, so that it opens from a disk, an e-mail or an autograder's feedback. It follows the reader's light or
dark setting, and stands still until it is asked to play.
"""

from __future__ import annotations

import html
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from sim.recording import Recording
from sim.view.artists import body_outline, is_full_turn, margin_of, movers_at, nose_outline, outlines
from sim.view.figures import describe
from sim.view.theme import DARK, LIGHT, Theme

MAX_ROWS = 3000
"""More rows than that are thinned out: the eye sees no difference."""

MAX_BEAMS = 180


def write_page(recording: Recording, path: Path) -> Path:
    """Write `recording`; see `sim.export.to_html`."""
    world = recording.simulation.world
    title = html.escape(f"{world.name}: {recording.times[-1]:.1f} s")
    page = _PAGE
    for name, text in {
        "TITLE": title,
        "ALT": html.escape(describe(recording), quote=True),
        "LIGHT": _colours(LIGHT),
        "DARK": _colours(DARK),
        "BOX": _view_box(recording),
        "WORLD": _world(recording),
        # "</" would end the script element; "\\u003c" is the same character to JSON.
        "DATA": json.dumps(_data(recording), separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
    }.items():
        page = page.replace(f"@{name}@", text)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(page, encoding="utf-8")
    return path


def _colours(theme: Theme) -> str:
    names = ["paper", "outside", "floor", "solid", "wall", "ink", "muted", "robot", "beam", "hit", "goal", "mover"]
    return "".join(f"--{name}:{getattr(theme, name)};" for name in names)


def _view_box(recording: Recording) -> str:
    left, low, right, high = recording.simulation.world.bounds
    margin = margin_of(recording.simulation.world)
    return f"{left - margin:.4g} {-high - margin:.4g} {right - left + 2 * margin:.4g} {high - low + 2 * margin:.4g}"


def _world(recording: Recording) -> str:
    """Return the world as SVG; y is turned over by the group it stands in."""
    world = recording.simulation.world
    room, solid = outlines(world)
    parts = [_shape([room], "floor")]
    if solid:
        parts.append(_shape(solid, "solid"))
    for goal in world.goals:
        parts.append(f'<circle class="goal" cx="{goal.x:g}" cy="{goal.y:g}" r="{goal.radius:g}"/>')
    lines = "".join(f"M{x1:g} {y1:g}L{x2:g} {y2:g}" for x1, y1, x2, y2 in world.segments.tolist())
    parts.append(f'<path class="wall" d="{lines}"/>')
    for x, y, radius in world.circles.tolist():
        parts.append(f'<circle class="pillar" cx="{x:g}" cy="{y:g}" r="{radius:g}"/>')
    return "".join(parts)


def _shape(loops: list[Any], name: str) -> str:
    path = "".join("M" + "L".join(f"{x:g} {y:g}" for x, y in loop.tolist()) + "Z" for loop in loops)
    return f'<path class="{name}" d="{path}"/>'


def _data(recording: Recording) -> dict[str, Any]:
    rows = np.unique(np.linspace(0, len(recording) - 1, min(len(recording), MAX_ROWS)).round().astype(int))
    world = recording.simulation.world
    return {
        "t": np.round(recording.times[rows], 4).tolist(),
        "robots": [
            {
                "poses": np.round(recording.poses[rows, index], 4).tolist(),
                "body": np.round(body_outline(spec), 4).tolist(),
                "nose": np.round(nose_outline(spec), 4).tolist(),
                "scans": _scans(recording, index),
            }
            for index, spec in enumerate(recording.simulation.robots)
        ],
        "movers": [mover.radius for mover in world.movers],
        "paths": [
            [[round(x, 3), round(y, 3)] for x, y in movers_at(recording.simulation, int(recording.times_ns[row]))]
            for row in (rows.tolist() if world.movers else ())
        ],
    }


def _scans(recording: Recording, index: int) -> dict[str, Any] | None:
    """Return the scans with at most `MAX_BEAMS` beams, ranges in millimetres: -1 no return, 0 nothing to show."""
    lidar, log = recording.simulation.robots[index].lidar, recording.scans[index]
    if lidar is None or not len(log.rows):
        return None
    keep = max(1, math.ceil(lidar.beams / MAX_BEAMS))
    ranges = log.ranges[:, ::keep].astype(np.float64)
    millimetres = np.zeros(ranges.shape, dtype=np.int64)
    finite = np.isfinite(ranges)
    millimetres[finite] = np.round(ranges[finite] * 1000).astype(np.int64)
    millimetres[ranges == math.inf] = -1
    return {
        "t": np.round(recording.times[log.rows], 4).tolist(),
        "poses": np.round(recording.poses[log.rows, index], 4).tolist(),
        "mount": [lidar.mount.x, lidar.mount.y, lidar.mount.theta],
        "first": lidar.angle_min,
        "step": lidar.angle_increment * keep,
        "reach": lidar.range_max,
        "full": is_full_turn(lidar),
        "mm": millimetres.tolist(),
    }


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>@TITLE@</title>
<style>
:root { @LIGHT@ }
@media (prefers-color-scheme: dark) { :root { @DARK@ } }
body { margin: 0; background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
main { max-width: 70rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.1rem; margin: 0 0 .5rem; }
svg { display: block; width: 100%; max-height: 78vh; background: var(--outside); border-radius: 6px; }
svg * { vector-effect: non-scaling-stroke; }
.floor { fill: var(--floor); } .solid { fill: var(--solid); }
.wall { fill: none; stroke: var(--wall); stroke-width: 2.5; stroke-linecap: round; }
.pillar { fill: var(--solid); stroke: var(--wall); stroke-width: 2; }
.goal { fill: var(--goal); fill-opacity: .14; stroke: var(--goal); stroke-width: 1.5; }
.mover { fill: var(--mover); } .seen { fill: var(--beam); fill-opacity: .13; }
.hits { fill: none; stroke: var(--hit); stroke-width: 4; stroke-linecap: round; }
.track { fill: none; stroke: var(--robot); stroke-width: 2.5; stroke-opacity: .6; }
.body { fill: var(--robot); stroke: var(--paper); stroke-width: 1.2; } .nose { fill: var(--paper); }
form { display: flex; gap: .75rem; align-items: center; margin-top: .6rem; }
button { font: inherit; padding: .3rem .9rem; border: 1px solid var(--muted); border-radius: 6px;
  background: none; color: inherit; cursor: pointer; min-width: 5.5rem; }
input { flex: 1; accent-color: var(--robot); } output { font-variant-numeric: tabular-nums; min-width: 5rem; }
</style>
</head>
<body>
<main>
<h1>@TITLE@</h1>
<svg viewBox="@BOX@" role="img" aria-label="@ALT@"><g transform="scale(1 -1)">@WORLD@<g id="moving"></g></g></svg>
<form>
<button type="button" id="play">Play</button>
<input type="range" id="time" min="0" max="1" step="any" value="0" aria-label="Time in seconds">
<output id="clock">0.00 s</output>
</form>
</main>
<script type="application/json" id="data">@DATA@</script>
<script>
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const layer = document.getElementById("moving");
const make = (tag, name) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  node.setAttribute("class", name);
  layer.append(node);
  return node;
};
const movers = data.movers.map(radius => {
  const disc = make("circle", "mover");
  disc.setAttribute("r", radius);
  return disc;
});
const robots = data.robots.map(robot => ({
  ...robot,
  parts: Object.fromEntries(["seen", "hits", "track", "body", "nose"].map(name => [name, make("path", name)])),
}));
const place = (points, [x, y, turn]) => points.map(([a, b]) =>
  [x + Math.cos(turn) * a - Math.sin(turn) * b, y + Math.sin(turn) * a + Math.cos(turn) * b]);
const line = points => points.length ? "M" + points.map(([x, y]) => x.toFixed(4) + " " + y.toFixed(4)).join("L") : "";
const last = (times, now) => {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= now + 1e-9) low = middle + 1; else high = middle;
  }
  return low - 1;
};
const drawScan = (robot, now) => {
  const scans = robot.scans, number = scans ? last(scans.t, now) : -1;
  if (number < 0) { robot.parts.seen.setAttribute("d", ""); robot.parts.hits.setAttribute("d", ""); return; }
  const [[x, y]] = place([scans.mount], scans.poses[number]), turn = scans.poses[number][2] + scans.mount[2];
  const ends = scans.mm[number].map((mm, beam) => {
    const angle = turn + scans.first + beam * scans.step, range = mm < 0 ? scans.reach : mm / 1000;
    return [x + range * Math.cos(angle), y + range * Math.sin(angle), mm > 0];
  });
  robot.parts.seen.setAttribute("d", line(scans.full ? ends : [[x, y], ...ends]) + "Z");
  robot.parts.hits.setAttribute("d", ends.filter(end => end[2]).map(end => line([end, end])).join(""));
};
const draw = now => {
  const row = Math.max(0, last(data.t, now));
  for (const robot of robots) {
    drawScan(robot, now);
    robot.parts.track.setAttribute("d", line(robot.poses.slice(0, row + 1)));
    robot.parts.body.setAttribute("d", line(place(robot.body, robot.poses[row])) + "Z");
    robot.parts.nose.setAttribute("d", line(place(robot.nose, robot.poses[row])) + "Z");
  }
  movers.forEach((disc, index) => {
    disc.setAttribute("cx", data.paths[row][index][0]);
    disc.setAttribute("cy", data.paths[row][index][1]);
  });
  document.getElementById("clock").textContent = now.toFixed(2) + " s";
};
const slider = document.getElementById("time"), button = document.getElementById("play");
const start = data.t[0], end = data.t[data.t.length - 1];
slider.min = start; slider.max = end;
let playing = false, now = start, before = null;
const frame = stamp => {
  if (!playing) return;
  now = Math.min(end, now + (before === null ? 0 : (stamp - before) / 1000));
  before = stamp;
  slider.value = now;
  draw(now);
  if (now >= end) setPlaying(false); else requestAnimationFrame(frame);
};
const setPlaying = value => {
  playing = value;
  before = null;
  button.textContent = playing ? "Pause" : "Play";
  if (playing) { if (now >= end) now = start; requestAnimationFrame(frame); }
};
button.addEventListener("click", () => setPlaying(!playing));
slider.addEventListener("input", () => { setPlaying(false); now = Number(slider.value); draw(now); });
slider.value = start;
draw(start);
</script>
</body>
</html>
"""
