"""Converts rows of a recording to states and scans, for views and exports."""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from sim.lidar import Scan
from sim.pose import Command, Pose
from sim.recording import Recording
from sim.simulation import State
from sim.state import Covariance, RobotState


def row_at(recording: Recording, time: float) -> int:
    """Return the row of the recording whose time is nearest to `time`, in seconds.

    Raises:
        ValueError: `time` is not finite.
    """
    if not math.isfinite(time):
        raise ValueError(f"there is no instant t = {time} s in a recording")
    return int(np.argmin(np.abs(recording.times - time)))


def state_at(recording: Recording, row: int) -> State:
    """Return the state in a row. It does not contain the robots' last commands, which watchdogs need."""
    simulation, time_ns = recording.simulation, int(recording.times_ns[row])
    robots = tuple(
        RobotState(
            name=spec.name,
            pose=Pose(*recording.poses[row, index].tolist()),
            velocity=Command(*recording.velocities[row, index].tolist()),
            odometry=Pose(*recording.odometry[row, index].tolist()),
            covariance=cast(Covariance, tuple(recording.covariances[row, index].tolist())),
            collided=bool(recording.collided[row, index]),
        )
        for index, spec in enumerate(simulation.robots)
    )
    return State(tick=round(time_ns / simulation.tick_ns), time_ns=time_ns, robots=robots)


def scan_at(recording: Recording, index: int, number: int) -> Scan:
    """Return a scan of a robot, with all the fields of LaserScan.

    Args:
        recording: the run.
        index: the index of the robot in the simulation.
        number: the number of the scan, from 0.

    Raises:
        ValueError: the robot has no lidar.
    """
    spec, log = recording.simulation.robots[index], recording.scans[index]
    lidar = spec.lidar
    if lidar is None:
        raise ValueError(f"robot {spec.name!r} has no lidar")
    return Scan(
        stamp_ns=int(log.stamps_ns[number]),
        ranges=log.ranges[number],
        intensities=log.intensities[number],
        angle_min=lidar.angle_min,
        angle_max=lidar.angle_max,
        angle_increment=lidar.angle_increment,
        time_increment=lidar.time_increment if lidar.skew else 0.0,
        scan_time=1.0 / lidar.rate,
        range_min=lidar.range_min,
        range_max=lidar.range_max,
    )


def newest_scan(recording: Recording, index: int, row: int) -> tuple[Scan, Pose] | None:
    """Return a robot's last scan up to a row, with the robot's pose at that scan; None before the first scan.

    Args:
        recording: the run.
        index: the index of the robot in the simulation.
        row: the last row to consider.
    """
    log = recording.scans[index]
    number = int(np.searchsorted(log.rows, row, side="right")) - 1
    if number < 0 or recording.simulation.robots[index].lidar is None:
        return None
    pose = Pose(*recording.poses[int(log.rows[number]), index].tolist())
    return scan_at(recording, index, number), pose
