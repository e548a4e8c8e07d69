"""Converts the simulator's values to ROS messages and back, with pure functions.

The bridge in real time and the grader in lockstep use these functions, so that a student's node receives the same bytes
from both.
"""

from __future__ import annotations

import array
import math
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, TransformStamped, TwistStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan

from sim.lidar import Scan
from sim.maps.grid import Grid
from sim.pose import Command, Pose
from sim.state import RobotState

NANOSECONDS = 1_000_000_000

_PLANAR = np.array([row * 6 + column for row in (0, 1, 5) for column in (0, 1, 5)])
"""The indices of x, y and yaw in the covariance of ROS's six axes, row by row."""


def time_to_msg(time_ns: int) -> Any:
    """Return `time_ns`, nanoseconds since the start of the run, as builtin_interfaces/Time."""
    seconds, nanoseconds = divmod(time_ns, NANOSECONDS)
    return Time(sec=seconds, nanosec=nanoseconds)


def clock_to_msg(time_ns: int) -> Any:
    """Return `time_ns` as rosgraph_msgs/Clock."""
    return Clock(clock=time_to_msg(time_ns))


def scan_to_msg(scan: Scan, frame_id: str | None = None) -> Any:
    """Return `scan` as sensor_msgs/LaserScan; `frame_id`, if given, replaces the scan's frame.

    The bits of the ranges do not change, including the infinities and nan of REP 117.
    """
    msg = LaserScan()
    msg.header.stamp = time_to_msg(scan.stamp_ns)
    msg.header.frame_id = scan.frame_id if frame_id is None else frame_id
    msg.angle_min = float(scan.angle_min)
    msg.angle_max = float(scan.angle_max)
    msg.angle_increment = float(scan.angle_increment)
    msg.time_increment = float(scan.time_increment)
    msg.scan_time = float(scan.scan_time)
    msg.range_min = float(scan.range_min)
    msg.range_max = float(scan.range_max)
    msg.ranges = array.array("f", scan.ranges.tobytes())
    msg.intensities = array.array("f", scan.intensities.tobytes())
    return msg


def odom_to_msg(robot: RobotState, time_ns: int, frame_id: str = "odom", child_frame_id: str = "base_link") -> Any:
    """Return the odometry of a robot's wheels as nav_msgs/Odometry.

    The covariance of x, y and yaw is the robot's. For the other axes it is 0, because a robot on a plane does not climb
    or tilt.

    Args:
        robot: the robot.
        time_ns: the simulated time in ns, for the stamp.
        frame_id: the frame of the pose (REP 105).
        child_frame_id: the frame of the twist.
    """
    msg = Odometry()
    msg.header.stamp = time_to_msg(time_ns)
    msg.header.frame_id = frame_id
    msg.child_frame_id = child_frame_id
    msg.pose.pose.position.x = float(robot.odometry.x)
    msg.pose.pose.position.y = float(robot.odometry.y)
    msg.pose.pose.orientation = yaw_to_quaternion(robot.odometry.theta)
    msg.pose.covariance[_PLANAR] = robot.covariance
    msg.twist.twist.linear.x = float(robot.velocity.linear)
    msg.twist.twist.angular.z = float(robot.velocity.angular)
    return msg


def truth_to_msg(robot: RobotState, time_ns: int, child_frame_id: str = "base_link") -> Any:
    """Return the true pose and velocity of a robot as nav_msgs/Odometry in frame `map`, without a covariance."""
    msg = Odometry()
    msg.header.stamp = time_to_msg(time_ns)
    msg.header.frame_id = "map"
    msg.child_frame_id = child_frame_id
    msg.pose.pose.position.x = float(robot.pose.x)
    msg.pose.pose.position.y = float(robot.pose.y)
    msg.pose.pose.orientation = yaw_to_quaternion(robot.pose.theta)
    msg.twist.twist.linear.x = float(robot.velocity.linear)
    msg.twist.twist.angular.z = float(robot.velocity.angular)
    return msg


def transform_to_msg(pose: Pose, time_ns: int, frame_id: str, child_frame_id: str) -> Any:
    """Return the pose of the child frame in the frame `frame_id` as geometry_msgs/TransformStamped."""
    msg = TransformStamped()
    msg.header.stamp = time_to_msg(time_ns)
    msg.header.frame_id = frame_id
    msg.child_frame_id = child_frame_id
    msg.transform.translation.x = float(pose.x)
    msg.transform.translation.y = float(pose.y)
    msg.transform.rotation = yaw_to_quaternion(pose.theta)
    return msg


def map_to_odom(robot: RobotState) -> Pose:
    """Return the pose of frame odom in frame map that corrects the drift, so that base_link has the true pose."""
    turn = robot.pose.theta - robot.odometry.theta
    cosine, sine = math.cos(turn), math.sin(turn)
    x, y = robot.odometry.x, robot.odometry.y
    return Pose(robot.pose.x - cosine * x + sine * y, robot.pose.y - sine * x - cosine * y, turn)


def grid_to_msg(grid: Grid, time_ns: int = 0) -> Any:
    """Return `grid` as nav_msgs/OccupancyGrid in frame `map`."""
    msg = OccupancyGrid()
    msg.header.stamp = msg.info.map_load_time = time_to_msg(time_ns)
    msg.header.frame_id = "map"
    msg.info.resolution = float(grid.resolution)
    msg.info.height, msg.info.width = grid.cells.shape
    msg.info.origin.position.x = float(grid.x)
    msg.info.origin.position.y = float(grid.y)
    msg.data = array.array("b", grid.cells.tobytes())
    return msg


def twist_to_command(msg: Any) -> Command:
    """Return the command in a geometry_msgs/Twist or TwistStamped for a differential drive.

    Only `linear.x` and `angular.z` count, because the robot cannot move in the other directions.

    Raises:
        ValueError: one of the two is not a finite number. Such a command must not reach a motor.
    """
    twist = msg.twist if isinstance(msg, TwistStamped) else msg
    linear, angular = twist.linear.x, twist.angular.z
    if not (math.isfinite(linear) and math.isfinite(angular)):
        raise ValueError(f"a command of {linear} m/s and {angular} rad/s is not finite; the robot can't execute it")
    return Command(linear=linear, angular=angular)


def yaw_to_quaternion(yaw: float) -> Any:
    """Return the rotation by `yaw` radians about z as geometry_msgs/Quaternion."""
    return Quaternion(z=math.sin(yaw / 2.0), w=math.cos(yaw / 2.0))
