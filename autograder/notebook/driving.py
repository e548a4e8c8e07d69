"""`drive` lets a program from the student's workspace control the simulated robot; `side_by_side` compares drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import yaml

from autograder import course_paths
from autograder.diagnosis import Kind
from autograder.exceptions import UsageError
from autograder.notebook.notices import TROUBLE, Notice
from autograder.notebook.publishing import EachStep, plan_messages
from autograder.notebook.worker_client import RECORDING, run_in_worker
from sim import (
    DeadSector,
    Faults,
    Recording,
    RobotSpec,
    Simulation,
    Window,
    World,
    load_recording,
)
from sim.codec import to_json
from sim.grading import grading
from sim.maps import load

if TYPE_CHECKING:
    from sim.view import Picture, Player

FAULTS = {
    "nan": Faults(sectors=(DeadSector(-0.05, 0.05),)),
    "dead": Faults(dead=(Window(10.0),)),
}
RADIUS = 0.18  # m; the robot's radius
WIDTH, HEIGHT = 6.0, 4.9  # inches; the size of one picture in `side_by_side`

Parameters = Mapping[str, object] | str | Path
"""Values by name, or the path of a parameter file. The `Node` of a launch file also takes both."""


@dataclass(frozen=True, eq=False)
class DriveReport:
    """A drive. It is shown in the player, or as a picture of the robot's track if the player is not available.

    The player plays once when it becomes visible. If the robot collides, it shows the first collision instead.

    Attributes:
        recording: the run: times, poses, scans, collisions.
        output: the program's log and printed output.
        commands: each command as (seconds, linear.x in m/s, angular.z in rad/s).
    """

    recording: Recording
    output: str
    commands: tuple[tuple[float, float, float], ...]

    @property
    def collided_at(self) -> float | None:
        """The time of the first collision in seconds, or None."""
        steps = self.recording.collided.any(axis=1).nonzero()[0]
        return float(self.recording.times[steps[0]]) if len(steps) else None

    @property
    def picture(self) -> Picture:
        """The robot's track, with its first collision marked."""
        from sim.view import plot

        note = "" if self.collided_at is None else "collision"
        return plot(self.recording, mark=self.collided_at, note=note)

    @property
    def player(self) -> Player:
        """A player of the run, with the distance to the nearest obstacle over time."""
        from sim.view import Margin, Player

        gaps = self.recording.clearances.min(axis=1).tolist()
        margin = Margin("the gap to the nearest thing, in m", self.recording.times.tolist(), gaps, self.collided_at)
        return Player(self.recording, margins=[margin], still=self.picture, play=True, note="collision")

    def __repr__(self) -> str:
        return self.picture.alt

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> object:
        return self.player._repr_mimebundle_(include, exclude)


def drive(
    package: str,
    executable: str,
    world: str | World = "empty_room",
    seconds: float = 30.0,
    *,
    faults: str | Faults | None = None,
    seed: int = 0,
    name: str | None = None,
    parameters: Parameters | None = None,
    each_step: EachStep | None = None,
    workspace: str | Path = "ws",
) -> DriveReport | Notice:
    """Build the workspace, let a program control the robot, and show its track.

    The program is the student's own `main()` with the real rclpy over DDS. It runs in its own process. Its ROS time is
    stepped: a minute takes a second or two, and each run gives the same result.

    Args:
        package: the package in `ws/src`.
        executable: the executable, as in `ros2 run PACKAGE EXECUTABLE`.
        world: the name of a world or a ROS map, or a `sim.World`.
        seconds: duration in ROS time.
        faults: faults of the lidar: "nan" (the beams straight ahead read nan), "dead" (no scan after 10 s), or a
            `sim.Faults`.
        seed: seed of the simulator's noise.
        name: a node name that replaces the one in the code.
        parameters: values by name, or the path of a parameter file.
        each_step: a function that returns additional messages to publish. It is called before the drive, once for
            each 0.1 s of it, with the seconds since its start (0.1, 0.2, ...). It returns messages by topic, such as
            `{"/mode": String(data="fast")}`, or None.
        workspace: the colcon workspace.

    Returns:
        The drive, or a notice with the reason why the robot could not move.

    Raises:
        UsageError: the world, fault, parameter file or workspace does not exist, or a return value of `each_step`
            cannot be published.
    """
    if grading():
        return Notice("The robot stays in its dock while the notebook is graded.")
    robot = RobotSpec(radius=RADIUS, faults=_resolve_faults(faults))
    world = world if isinstance(world, World) else load(course_paths.world_path(world))
    simulation = Simulation(world, (robot,), seed=seed)
    with run_in_worker(
        "drive",
        Path(workspace),
        package=package,
        executable=executable,
        simulation=to_json(simulation),
        seconds=float(seconds),
        options=["-r", f"__node:={name}"] if name else [],
        parameter_file="" if parameters is None else _parameter_file_text(parameters),
        published=None if each_step is None else plan_messages(each_step, float(seconds), Path(workspace)),
    ) as (reply, folder):
        diagnosis = reply["diagnosis"]
        if diagnosis["kind"] != Kind.OK.value:
            return Notice(diagnosis["sentence"], diagnosis["detail"], TROUBLE)
        commands = tuple((float(t), float(v), float(w)) for t, v, w in reply["commands"])
        return DriveReport(load_recording(folder / RECORDING), reply["output"], commands)


def side_by_side(drives: Mapping[str, DriveReport | Notice]) -> Picture | Notice:
    """Show the tracks of drives next to each other, each with its title, or the first notice among them.

    Args:
        drives: one or more results of `drive`, by their titles.
    """
    from matplotlib.figure import Figure

    from sim.view import LIGHT, Picture, plot

    reports: dict[str, DriveReport] = {}
    for title, report in drives.items():
        if isinstance(report, Notice):
            return report
        reports[title] = report
    figure = Figure(figsize=(WIDTH * len(reports), HEIGHT), facecolor=LIGHT.paper, layout="constrained")
    axes = figure.subplots(1, len(reports), squeeze=False)[0]
    alts = [
        f"{title}: {plot(report.recording, ax=ax, title=title).alt}"
        for ax, (title, report) in zip(axes, reports.items(), strict=True)
    ]
    return Picture(figure, " ".join(alts))


def _resolve_faults(faults: str | Faults | None) -> Faults:
    if faults is None:
        return Faults()
    if isinstance(faults, Faults):
        return faults
    if faults not in FAULTS:
        raise UsageError(f"unknown fault {faults!r}: use {', '.join(FAULTS)}, or your own sim.Faults")
    return FAULTS[faults]


def _parameter_file_text(parameters: Parameters) -> str:
    """Return the text of a parameter file with these values."""
    if isinstance(parameters, Mapping):
        try:
            return yaml.safe_dump({"/**": {"ros__parameters": dict(parameters)}})
        except yaml.representer.RepresenterError as error:
            kind = type(error.args[-1]).__name__
            raise UsageError(f"a parameter must be a bool, int, float, str or a list of these, not {kind}") from None
    if not Path(parameters).is_file():
        raise UsageError(f"parameter file {parameters} not found: give its path relative to the notebook's folder")
    return Path(parameters).read_text()
