"""A lidar: the description of the sensor, and its scans with every field of LaserScan."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.exceptions import SpecError
from sim.pose import ORIGIN, Pose

Float32s = NDArray[np.float32]

MAX_BEAMS = 100_000
MAX_RANGE = 10_000.0


@dataclass(frozen=True, slots=True)
class LidarSpec:
    """A planar lidar: `beams` beams from `angle_min` on, at steps of `angle_increment` (radians, in frame `laser`).

    Ranges are in metres, and `rate` is in scans a second. `noise` is the standard deviation of a range in metres, and
    `dropout` the probability that a beam is lost. `mount` is the pose of `laser` in `base_link`. With `skew`, the beams
    are measured one after the other over a whole turn while the robot moves, as by a real lidar. Without it, all are
    measured at once, and `time_increment` is 0.
    """

    name: str = "LDS-01"
    beams: int = 360
    angle_min: float = 0.0
    angle_increment: float = math.tau / 360
    range_min: float = 0.12
    range_max: float = 3.5
    rate: float = 5.0
    noise: float = 0.0
    dropout: float = 0.0
    intensities: bool = True
    skew: bool = False
    mount: Pose = ORIGIN

    def __post_init__(self) -> None:
        for name, is_valid, remedy in (
            ("beams", 1 <= self.beams <= MAX_BEAMS, f"from 1 to {MAX_BEAMS}"),
            ("angle_min", -math.tau <= self.angle_min <= math.tau, "an angle in radians within a turn of 0"),
            ("angle_increment", 1e-7 <= self.angle_increment <= math.tau, "radians, from 1e-7 to a whole turn"),
            ("range_max", 0.0 < self.range_max <= MAX_RANGE, f"metres, above 0 and at most {MAX_RANGE:.0f}"),
            ("range_min", 0.0 <= self.range_min < self.range_max, "metres, from 0 to below range_max"),
            ("rate", 0.0 < self.rate <= 1000.0, "scans a second, above 0 and at most 1000"),
            ("noise", 0.0 <= self.noise <= self.range_max, "a standard deviation in metres, 0 or above"),
            ("mount", all(map(math.isfinite, (self.mount.x, self.mount.y, self.mount.theta))), "a finite pose"),
            ("dropout", 0.0 <= self.dropout <= 1.0, "a probability from 0 to 1"),
        ):
            if not is_valid:
                raise SpecError(f"lidar {self.name!r}: {name} is {getattr(self, name)}; give {remedy}")
        if self.beams * self.angle_increment > math.tau * (1.0 + 1e-9):
            raise SpecError(
                f"lidar {self.name!r}: {self.beams} beams {self.angle_increment} rad apart cover more than a turn, "
                "so that beams would overlap; give fewer beams or a smaller angle_increment"
            )

    @property
    def angle_max(self) -> float:
        """The last beam's angle in radians, which is less than a turn from the first."""
        return self.angle_min + (self.beams - 1) * self.angle_increment

    @property
    def time_increment(self) -> float:
        """The time between two beams in seconds, if they are measured one after the other."""
        return self.angle_increment / math.tau / self.rate


LDS_01 = LidarSpec()
RPLIDAR_A1 = LidarSpec(
    name="RPLIDAR A1",
    beams=360,
    angle_min=-math.pi,
    angle_increment=math.tau / 360,
    range_min=0.15,
    range_max=12.0,
    rate=5.5,
)
UTM_30LX = LidarSpec(
    name="UTM-30LX",
    beams=1081,
    angle_min=-math.radians(135),
    angle_increment=math.radians(0.25),
    range_min=0.1,
    range_max=30.0,
    rate=40.0,
)


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """One scan: the fields of sensor_msgs/LaserScan under their own names, and `stamp_ns` and `frame_id` of its header.

    `ranges` and `intensities` are float32 of shape (beams,), read-only. By REP 117, `+inf` means that nothing
    was hit, `-inf` that an object is too close to measure, and `nan` that the measurement is invalid. `intensities` is
    empty if the lidar does not measure them.
    `stamp_ns` is the simulated time of the first beam in nanoseconds.
    """

    stamp_ns: int
    ranges: Float32s
    intensities: Float32s
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    frame_id: str = "laser"
