"""Scans, odometry and commands as ROS messages: every field, every bit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from geometry_msgs.msg import Twist, TwistStamped
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import LaserScan

from sim import Command, Pose, RobotState, Scan
from sim.bridge.messages import (
    clock_to_msg,
    odom_to_msg,
    scan_to_msg,
    time_to_msg,
    twist_to_command,
    yaw_to_quaternion,
)


def scan(ranges: list[float]) -> Scan:
    return Scan(
        stamp_ns=12_400_000_001,
        ranges=np.array(ranges, dtype=np.float32),
        intensities=np.arange(len(ranges), dtype=np.float32),
        angle_min=-1.0,
        angle_max=1.0,
        angle_increment=0.5,
        time_increment=0.001,
        scan_time=0.2,
        range_min=0.12,
        range_max=3.5,
    )


def test_a_scan_keeps_every_field() -> None:
    msg = scan_to_msg(scan([0.5, 1.0, 1.5, 2.0, 2.5]))
    assert isinstance(msg, LaserScan)
    assert (msg.header.stamp.sec, msg.header.stamp.nanosec, msg.header.frame_id) == (12, 400_000_001, "laser")
    fields = (msg.angle_min, msg.angle_max, msg.angle_increment, msg.time_increment, msg.scan_time)
    assert fields == (-1.0, 1.0, 0.5, 0.001, 0.2)
    assert (msg.range_min, msg.range_max) == (0.12, 3.5)
    assert msg.ranges.tolist() == [0.5, 1.0, 1.5, 2.0, 2.5]
    assert msg.intensities.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]


@given(st.lists(st.floats(width=32)))
def test_ranges_keep_their_bits(ranges: list[float]) -> None:
    given_scan = scan(ranges)
    assert scan_to_msg(given_scan).ranges.tobytes() == given_scan.ranges.tobytes()


def test_the_frame_of_a_scan_can_be_chosen() -> None:
    assert scan_to_msg(scan([1.0]), "alpha/laser").header.frame_id == "alpha/laser"


def test_odometry_has_the_pose_the_twist_and_the_covariance() -> None:
    robot = RobotState(
        name="robot",
        pose=Pose(9.0, 9.0, 9.0),
        velocity=Command(0.2, -0.4),
        odometry=Pose(1.0, -2.0, 0.5),
        covariance=(1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0),
    )
    msg = odom_to_msg(robot, 1_500_000_000, "a/odom", "a/base_link")
    assert (msg.header.frame_id, msg.child_frame_id) == ("a/odom", "a/base_link")
    assert (msg.header.stamp.sec, msg.header.stamp.nanosec) == (1, 500_000_000)
    assert (msg.pose.pose.position.x, msg.pose.pose.position.y) == (1.0, -2.0)
    assert msg.pose.pose.orientation == yaw_to_quaternion(0.5)
    assert (msg.twist.twist.linear.x, msg.twist.twist.angular.z) == (0.2, -0.4)
    covariance = np.reshape(msg.pose.covariance, (6, 6))
    assert covariance[np.ix_((0, 1, 5), (0, 1, 5))].ravel().tolist() == list(robot.covariance)
    assert np.count_nonzero(covariance) == 9


@given(st.floats(-3.1, 3.1))
def test_a_quaternion_turns_by_the_yaw_about_z_only(yaw: float) -> None:
    rotation = yaw_to_quaternion(yaw)
    assert 2.0 * math.atan2(rotation.z, rotation.w) == pytest.approx(yaw, abs=1e-12)
    assert (rotation.x, rotation.y) == (0.0, 0.0)


@given(st.floats(-10, 10), st.floats(-10, 10))
def test_a_command_survives_conversion_to_twist_and_twist_stamped(linear: float, angular: float) -> None:
    command = Command(linear, angular)
    twist, stamped = Twist(), TwistStamped()
    twist.linear.x, twist.angular.z = linear, angular
    stamped.twist = twist
    assert twist_to_command(twist) == twist_to_command(stamped) == command


def test_speeds_that_a_differential_drive_cannot_have_are_omitted() -> None:
    msg = Twist()
    msg.linear.y = msg.linear.z = msg.angular.x = 5.0
    assert twist_to_command(msg) == Command()


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_finite_is_refused(value: float) -> None:
    for field in ("linear", "angular"):
        msg = Twist()
        setattr(getattr(msg, field), "x" if field == "linear" else "z", value)
        with pytest.raises(ValueError, match="is not finite; the robot can't execute it"):
            twist_to_command(msg)


def test_times_are_exact_to_the_nanosecond() -> None:
    time_ns = 4_000_000_000_999_999_999 // 2
    assert time_to_msg(time_ns).sec * 1_000_000_000 + time_to_msg(time_ns).nanosec == time_ns
    assert clock_to_msg(1_000_000_001).clock == time_to_msg(1_000_000_001)
