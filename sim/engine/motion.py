"""The motion of a differential drive: exact arcs, limited accelerations, odometry that drifts, and contacts.

A robot is a vector of 14 numbers: x, y, theta, v, w, then the odometry's x, y, theta, then the upper triangle of its
covariance. During a tick, v and w are constant, so its path is an arc of a circle, with the chord v dt sinc(w dt / 2)
at the heading after half the turn. The code is plain Python, which the compiled engine compiles.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim.engine.shapes import gap
from sim.engine.trig import sinc, sincos, wrap

Floats = NDArray[np.float64]

# The gap at a contact is two skins (m). Sliding may reduce it to one, but no motion makes a gap smaller than that.
SKIN = 1e-6
# The minimum distance that a robot moves between two computations of the gap, in metres.
STRIDE = 1e-3
# The number of bisections of an interval that contains a contact.
HALVINGS = 39
# If the gap is too small at all these shares of the interval, the robot leans on the obstacle and stops at once.
LEANING_SHARES = (0.5**39, 0.5**26, 0.5**13)

Motion = tuple[float, float, float, float]
"""The speeds along an arc, v in m/s and w in rad/s, and the slip in x and in y, in m/s."""


def approach(value: float, target: float, max_change: float) -> float:
    """Return `value` moved towards `target` by at most `max_change`."""
    return value + min(max(target - value, -max_change), max_change)


def along_arc(x: float, y: float, theta: float, v: float, w: float, dt: float) -> tuple[float, float, float]:
    """Return the pose after `dt` seconds at the constant speeds v and w. It is exact for any w."""
    half = 0.5 * (w * dt)
    s, c = sincos(theta + half)
    chord = v * dt * sinc(half)
    return x + chord * c, y + chord * s, wrap(theta + w * dt)


def measure(robot: Floats, ds: float, turn: float, drift: Floats, noise: Floats) -> None:
    """Add a motion of `ds` metres and `turn` radians to the odometry and its covariance.

    `drift` contains the variances of the distance per metre, of the turn per radian and of the turn per metre. `noise`
    contains two standard normal numbers. The covariance is propagated to first order about the measured motion.
    """
    distance_variance = drift[0] * abs(ds)
    turn_variance = drift[1] * abs(turn) + drift[2] * abs(ds)
    has_noise = distance_variance + turn_variance > 0.0
    if has_noise:
        ds += math.sqrt(distance_variance) * noise[0]
        turn += math.sqrt(turn_variance) * noise[1]
    s, c = sincos(robot[7] + 0.5 * turn)
    chord = ds * sinc(0.5 * turn)
    robot[5] += chord * c
    robot[6] += chord * s
    robot[7] = wrap(robot[7] + turn)
    if drift[0] + drift[1] + drift[2] > 0.0:
        # P := F P F' + V Q V', F = [[1, 0, fx], [0, 1, fy], [0, 0, 1]], V = [[c, fx / 2], [s, fy / 2], [0, 1]]
        fx = -ds * s
        fy = ds * c
        xx, xy, xt, yy, yt, tt = robot[8], robot[9], robot[10], robot[11], robot[12], robot[13]
        q, r = distance_variance, turn_variance
        robot[8] = xx + 2.0 * fx * xt + fx * fx * tt + c * c * q + 0.25 * fx * fx * r
        robot[9] = xy + fx * yt + fy * xt + fx * fy * tt + c * s * q + 0.25 * fx * fy * r
        robot[10] = xt + fx * tt + 0.5 * fx * r
        robot[11] = yy + 2.0 * fy * yt + fy * fy * tt + s * s * q + 0.25 * fy * fy * r
        robot[12] = yt + fy * tt + 0.5 * fy * r
        robot[13] = tt + r


def advance_unobstructed(
    robot: Floats, v: float, w: float, ticks: int, dt: float, limits: Floats, drift: Floats, noise: Floats
) -> None:
    """Advance `robot` by `ticks` ticks of `dt` seconds towards the speeds v and w, if no obstacle is near.

    `limits` are the largest speeds and accelerations, linear and angular: m/s, rad/s, m/s², rad/s². `noise` is
    (ticks, 2).
    """
    for tick in range(ticks):
        robot[3] = approach(robot[3], min(max(v, -limits[0]), limits[0]), limits[2] * dt)
        robot[4] = approach(robot[4], min(max(w, -limits[1]), limits[1]), limits[3] * dt)
        robot[0], robot[1], robot[2] = along_arc(robot[0], robot[1], robot[2], robot[3], robot[4], dt)
        measure(robot, robot[3] * dt, robot[4] * dt, drift, noise[tick])


def pose_after(x: float, y: float, theta: float, motion: Motion, t: float) -> tuple[float, float, float]:
    """Return the pose after `t` seconds of a motion."""
    a, b, c = along_arc(x, y, theta, motion[0], motion[1], t)
    return a + motion[2] * t, b + motion[3] * t, c


def sweep(
    pose: Floats, motion: Motion, dt: float, min_gap: float, body: Floats, walls: Floats, circles: Floats, touch: Floats
) -> float:
    """Move `pose` (x, y, theta) until it meets an obstacle; return the share of `dt` until then, 1 if it meets none.

    The gap to the obstacles does not fall below `min_gap` or, if that is smaller, its initial value. `body` is the same
    as in `shapes.gap`, which fills `touch`.
    """
    x, y, theta = pose[0], pose[1], pose[2]
    current_gap = gap(x, y, theta, body, walls, circles, touch)
    min_gap = min(min_gap, current_gap)
    max_distance = (abs(motion[0]) + abs(motion[2]) + abs(motion[3]) + abs(motion[1]) * body[0, 1]) * dt
    completed_share = 0.0
    while completed_share < 1.0 and max_distance > 0.0:
        high = min(completed_share + max(current_gap - SKIN, STRIDE) / max_distance, 1.0)
        a, b, c = pose_after(x, y, theta, motion, high * dt)
        current_gap = gap(a, b, c, body, walls, circles, touch)
        if current_gap >= min_gap:
            pose[0], pose[1], pose[2] = a, b, c
            completed_share = high
            continue
        obstacle = touch[0]
        is_leaning = True
        for share in LEANING_SHARES:
            a, b, c = pose_after(x, y, theta, motion, (completed_share + share * (high - completed_share)) * dt)
            is_leaning = is_leaning and gap(a, b, c, body, walls, circles, touch) < min_gap and touch[0] == obstacle
        for _ in range(0 if is_leaning else HALVINGS):
            share = 0.5 * (completed_share + high)
            a, b, c = pose_after(x, y, theta, motion, share * dt)
            if gap(a, b, c, body, walls, circles, touch) >= min_gap:
                pose[0], pose[1], pose[2] = a, b, c
                completed_share = share
            else:
                high = share
        gap(pose[0], pose[1], pose[2], body, walls, circles, touch)
        return completed_share
    return 1.0


def advance_near_obstacles(
    robot: Floats,
    v: float,
    w: float,
    dt: float,
    limits: Floats,
    drift: Floats,
    noise: Floats,
    body: Floats,
    walls: Floats,
    circles: Floats,
    slide: bool,
    touch: Floats,
) -> bool:
    """Advance `robot` by one tick if an obstacle is near; return whether it was in contact.

    After a contact, a robot that does not slide stops, but continues to turn in place. A robot that slides keeps the
    part of its motion along the obstacle. `touch` then describes the contact (see `shapes.gap`), and its sixth number
    is the speed of the impact.
    """
    robot[3] = approach(robot[3], min(max(v, -limits[0]), limits[0]), limits[2] * dt)
    robot[4] = approach(robot[4], min(max(w, -limits[1]), limits[1]), limits[3] * dt)
    v, w = robot[3], robot[4]
    pose = robot[:3]
    if gap(pose[0], pose[1], pose[2], body, walls, circles, touch) < 0.0:
        # A moving obstacle has run into the robot, which may still move away.
        touch[5] = abs(v)
        share = sweep(pose, (v, w, 0.0, 0.0), dt, 0.0, body, walls, circles, np.empty(6))
        if share < 1.0:
            robot[3] = 0.0
        measure(robot, v * dt * share, w * dt * share, drift, noise)
        return True
    share = sweep(pose, (v, w, 0.0, 0.0), dt, 2.0 * SKIN, body, walls, circles, touch)
    if share == 1.0:
        measure(robot, v * dt, w * dt, drift, noise)
        return False
    ds, turn = v * dt * share, w * dt * share
    remaining_time = dt * (1.0 - share)
    nx, ny = touch[3], touch[4]
    s, c = sincos(pose[2])
    sx = 0.0
    sy = 0.0
    if slide:
        inward_speed = min(v * (c * nx + s * ny), 0.0)
        sx = v * c - inward_speed * nx
        sy = v * s - inward_speed * ny
    unused_touch = np.empty(6)
    further_share = sweep(pose, (0.0, w, sx, sy), remaining_time, SKIN, body, walls, circles, unused_touch)
    if further_share < 1.0 and slide:  # in a corner, only the turn remains
        further_share = sweep(
            pose, (0.0, w, 0.0, 0.0), remaining_time * (1.0 - further_share), SKIN, body, walls, circles, unused_touch
        )
        sx = 0.0
        sy = 0.0
    robot[3] = v if slide else 0.0
    robot[4] = w if further_share == 1.0 else 0.0
    measure(robot, ds + (c * sx + s * sy) * remaining_time, turn + robot[4] * remaining_time, drift, noise)
    touch[5] = abs(v)
    return True
