"""Static pictures: `show` draws a world, and `plot` a recording. They need no kernel, widget or backend."""

from __future__ import annotations

from typing import Any, Literal

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sim.pose import Pose
from sim.recording import Recording
from sim.rows import newest_scan, row_at
from sim.simulation import Simulation, State, observe
from sim.view import artists
from sim.view.picture import Picture
from sim.view.shapes import moment_of, movers_at
from sim.view.stage import add_scale, new_axes, prepare, write_names
from sim.view.theme import STYLE, Theme, theme_named
from sim.world import World

CLEARANCE_SCALE = 0.6
"""The clearance in metres at the far end of a track's colours."""


def show(
    subject: World | Simulation,
    state: State | None = None,
    *,
    ax: Axes | None = None,
    theme: str | Theme = "light",
    names: bool = True,
    title: str | None = None,
) -> Picture:
    """Draw a world and, with a simulation and a state, also its robots and their scans.

    Args:
        subject: a world, or a simulation with its robots.
        state: the state of the robots. Without a state, they are not drawn.
        ax: the Axes to draw on, by default those of a new figure.
        theme: "light", "dark", or a `Theme`.
        names: whether to write the names of walls and goals.
        title: the title of the picture, by default the world's name.
    """
    simulation = subject if isinstance(subject, Simulation) else Simulation(subject)
    world, colours = simulation.world, theme_named(theme)
    with matplotlib.rc_context(STYLE):  # type: ignore[arg-type]
        ax = ax or new_axes(world, colours)
        prepare(ax, world, colours, title or title_of(world), size_of(world))
        _draw_world(ax, simulation, 0 if state is None else state.time_ns, colours, names, state is None)
        if state is not None:
            for index, robot in enumerate(state.robots):
                spec = simulation.robots[index]
                scan = observe(simulation, state, spec.name) if spec.lidar is not None else None
                if scan is not None and spec.lidar is not None:
                    artists.draw_scan(ax, scan.ranges, spec.lidar, robot.pose, colours)
                artists.draw_robot(ax, spec, robot.pose, colours, colours.robot_colour(index))
                _name_robot(ax, simulation, index, robot.pose, colours)
    return Picture(_figure(ax), _world_alt(world, state))


def plot(
    recording: Recording,
    *,
    robot: str | None = None,
    colour: Literal["time", "clearance"] = "time",
    mark: float | None = None,
    note: str = "",
    ax: Axes | None = None,
    theme: str | Theme = "light",
    names: bool = False,
    title: str | None = None,
) -> Picture:
    """Draw the tracks of a recording, its collisions, and its nearest approach or a marked instant.

    Args:
        recording: the run.
        robot: the name of the robot to draw; all robots if None.
        colour: the quantity that the colour of a track shows.
        mark: a time in seconds. The robot is drawn at this time, with its scan and a line to the nearest obstacle.
        note: the text beside the mark.
        ax: the Axes to draw on, by default those of a new figure.
        theme: "light", "dark", or a `Theme`.
        names: whether to write the names of walls and goals.
        title: the title of the picture, by default the world's name.

    Raises:
        ValueError: the recording does not have the robot, or the colour or the mark is invalid.
    """
    simulation, world, scheme = recording.simulation, recording.simulation.world, theme_named(theme)
    if colour not in ("time", "clearance"):
        raise ValueError(f"a track has no colour {colour!r}: choose time or clearance")
    indices = _robot_indices(simulation, robot)
    moment = moment_of(recording, indices, mark, note)
    row = None if mark is None else row_at(recording, mark)
    shown_row = len(recording) - 1 if row is None else row
    with matplotlib.rc_context(STYLE):  # type: ignore[arg-type]
        ax = ax or new_axes(world, scheme)
        prepare(ax, world, scheme, title or title_of(world), _summary(recording, indices, nearest=len(indices) == 1))
        _draw_world(ax, simulation, int(recording.times_ns[shown_row]), scheme, names)
        for index in reversed(indices):
            _draw_robot_run(ax, recording, index, colour, scheme, shown_row, scan=row is None or index == indices[0])
        _add_scale(ax, recording, indices[0], colour, scheme)
        if moment is not None:
            artists.draw_moment(ax, moment, world, scheme)
    return Picture(_figure(ax), _track_alt(recording, indices, mark, note))


def heading(recording: Recording) -> tuple[str, str]:
    """Return the title of a run, and its summary: the duration, the distance and the collisions."""
    indices = _robot_indices(recording.simulation, None)
    return title_of(recording.simulation.world), _summary(recording, indices, nearest=len(indices) == 1)


def _draw_world(ax: Axes, simulation: Simulation, time_ns: int, theme: Theme, names: bool, starts: bool = True) -> None:
    world = simulation.world
    artists.draw_walls(ax, world, theme)
    artists.draw_places(ax, world, theme, radius=simulation.robots[0].radius, starts=starts)
    for mover, (x, y) in zip(world.movers, movers_at(simulation, time_ns), strict=True):
        ax.add_patch(artists.mover_patch(x, y, mover.radius, theme))
    if names:
        write_names(ax, world, theme)


def _draw_robot_run(
    ax: Axes, recording: Recording, index: int, colour: str, theme: Theme, shown_row: int, *, scan: bool
) -> None:
    points, robot_colour = recording.poses[:, index, :2], theme.robot_colour(index)
    if colour == "time":
        artists.draw_track(ax, points, recording.times, theme.time_colours(index), _time_limits(recording))
    else:
        values = recording.clearances[:, index]
        artists.draw_track(ax, points, values, theme.clearance_colours, (0.0, CLEARANCE_SCALE))
    spec = recording.simulation.robots[index]
    events = [event for event in recording.events if event.kind == "collision" and event.robot == spec.name]
    if scan:
        _draw_last_scan(ax, recording, index, shown_row, theme)
    artists.draw_crosses(ax, [(event.x, event.y) for event in events], theme)
    pose = Pose(*recording.poses[shown_row, index].tolist())
    artists.draw_robot(ax, spec, pose, theme, robot_colour)
    _name_robot(ax, recording.simulation, index, pose, theme)


def _name_robot(ax: Axes, simulation: Simulation, index: int, pose: Pose, theme: Theme) -> None:
    """Write a robot's name beside it, if there are several."""
    if len(simulation.robots) > 1:
        spec = simulation.robots[index]
        artists.name_text(ax, spec.name, theme).xy = artists.anchor_of_name(spec, pose)


def _add_scale(ax: Axes, recording: Recording, index: int, colour: str, theme: Theme) -> None:
    if colour == "time":
        add_scale(ax, theme.time_colours(index), _time_limits(recording), "s", "time", theme)
    else:
        add_scale(ax, theme.clearance_colours, (0.0, CLEARANCE_SCALE), "m", "clearance", theme)


def _time_limits(recording: Recording) -> tuple[float, float]:
    first, last = recording.times[[0, -1]].tolist()
    return first, max(last, first + 1e-9)


def _draw_last_scan(ax: Axes, recording: Recording, index: int, row: int, theme: Theme) -> None:
    lidar, newest = recording.simulation.robots[index].lidar, newest_scan(recording, index, row)
    if lidar is not None and newest is not None:
        artists.draw_scan(ax, newest[0].ranges, lidar, newest[1], theme)


def _robot_indices(simulation: Simulation, robot: str | None) -> list[int]:
    names = [spec.name for spec in simulation.robots]
    if robot is None:
        return list(range(len(names)))
    if robot not in names:
        raise ValueError(f"the recording has no robot {robot!r}: it has {', '.join(names)}")
    return [names.index(robot)]


def _figure(ax: Axes) -> Figure:
    figure: Any = ax.get_figure(root=True)
    return figure  # type: ignore[no-any-return]


def title_of(world: World) -> str:
    """Return the name of a world, with a capital letter."""
    return world.name[:1].upper() + world.name[1:]


def size_of(world: World) -> str:
    """Return the width and the height of a world."""
    left, low, right, high = world.bounds
    return f"{right - left:.1f} × {high - low:.1f} m"  # noqa: RUF001 (a true multiplication sign)


def _summary(recording: Recording, indices: list[int], *, nearest: bool = True) -> str:
    """Summarise the run of each robot. For several robots, a heading has no room for the nearest distances."""
    seconds = f"{recording.times[-1] - recording.times[0]:.1f} s"
    if len(indices) == 1:
        return " · ".join([seconds, *_run_facts(recording, indices[0], nearest)])
    robots = recording.simulation.robots
    return " · ".join([seconds, *(f"{robots[i].name} {', '.join(_run_facts(recording, i, nearest))}" for i in indices)])


def _run_facts(recording: Recording, index: int, nearest: bool) -> list[str]:
    """Return a robot's distance, its collisions and, if `nearest`, its smallest clearance, as texts."""
    length = float(np.hypot(*np.diff(recording.poses[:, index, :2], axis=0).T).sum())
    name, clearances = recording.simulation.robots[index].name, recording.clearances[:, index]
    collision_count = sum(event.kind == "collision" and event.robot == name for event in recording.events)
    parts = [f"{length:.1f} m driven"]
    if collision_count:
        parts.append(f"{collision_count} collision{'s' if collision_count > 1 else ''}")
    elif nearest and np.isfinite(clearances).any():
        parts.append(f"never nearer than {max(0.0, float(np.nanmin(clearances))):.2f} m")
    return parts


def _world_alt(world: World, state: State | None) -> str:
    text = f"Map of the world “{world.name}”, {size_of(world)}, with {len(world.segments)} walls"
    if len(world.circles):
        text += f", {len(world.circles)} pillars"
    if world.movers:
        text += f", {len(world.movers)} moving obstacles"
    for robot in state.robots if state is not None else ():
        text += f"; {robot.name} at ({robot.pose.x:.2f} m, {robot.pose.y:.2f} m)"
    return text + "."


def _track_alt(recording: Recording, indices: list[int], mark: float | None, note: str) -> str:
    names = [recording.simulation.robots[index].name for index in indices]
    ends = [f"({x:.2f} m, {y:.2f} m)" for x, y, _ in recording.poses[-1, indices].tolist()]
    text = f"Track of {' and '.join(names)} through “{recording.simulation.world.name}”: "
    text += f"{_summary(recording, indices)}; {'it ends' if len(ends) == 1 else 'they end'} at {' and '.join(ends)}"
    if mark is not None:
        text += f". Marked: t = {mark:.1f} s" + (f", {note}" if note else "")
    return text + "."
