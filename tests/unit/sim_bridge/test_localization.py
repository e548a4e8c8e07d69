"""Frames, the map, the true pose and reliable scans of the node, received by a node of another context."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

from sim import Command, load_world
from sim.bridge import Bridge
from sim.bridge.localization import LATCHED, TF_QOS
from sim.maps.grid import grid_of

ROOT = Path(__file__).resolve().parents[3]
WORLD = ROOT / "assets" / "worlds" / "empty_room.yaml"
PATIENCE = 60.0
RELIABLE = QoSProfile(depth=10)
"""The profile of a subscription that was created with a plain depth."""


class Listener:
    """A node that keeps the messages of some topics."""

    def __init__(self, domain: int) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
        self._node = Node("listener", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)

    def collect(self, kind: Any, topic: str, qos: QoSProfile) -> list[Any]:
        """Return the list that fills with the topic's messages."""
        messages: list[Any] = []
        self._node.create_subscription(kind, topic, messages.append, qos)
        return messages

    def wait_until(self, condition: Callable[[], bool]) -> None:
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, "the condition never held"
            self._executor.spin_once(timeout_sec=0.05)

    def stop(self) -> None:
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.try_shutdown()


@pytest.fixture
def listener(ros_domain: int) -> Iterator[Listener]:
    listening = Listener(ros_domain)
    yield listening
    listening.stop()


@contextmanager
def driving_bridge(domain: int, **settings: Any) -> Iterator[Bridge]:
    """A bridge whose robot drives a curve, with odometry that drifts."""
    with Bridge(WORLD, domain_id=domain, engine="numpy", speed=2.0, **settings) as bridge:
        bridge.driver.command("robot", Command(0.3, 0.4))
        yield bridge


def planar_matrix(transform: Any) -> np.ndarray[Any, Any]:
    """A transform as a matrix, (3, 3)."""
    position, rotation = transform.transform.translation, transform.transform.rotation
    assert rotation.z**2 + rotation.w**2 == pytest.approx(1.0)
    angle = 2.0 * math.atan2(rotation.z, rotation.w)
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine, position.x], [sine, cosine, position.y], [0.0, 0.0, 1.0]])


def points_of(scan: Any, laser: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """The points that a scan hits, x and y (2, N), if the lidar's frame has the pose `laser` (3, 3)."""
    ranges = np.array(scan.ranges)
    (hits,) = np.nonzero(np.isfinite(ranges))
    angles, distances = scan.angle_min + scan.angle_increment * hits, ranges[hits]
    points: np.ndarray[Any, Any] = laser @ np.array(
        [distances * np.cos(angles), distances * np.sin(angles), np.ones(len(hits))]
    )
    return points[:2]


def stamp(header: Any) -> tuple[int, int]:
    return header.stamp.sec, header.stamp.nanosec


def test_a_reliable_scan_serves_reliable_and_best_effort_subscriptions(ros_domain: int, listener: Listener) -> None:
    reliable = listener.collect(LaserScan, "/scan", RELIABLE)
    best_effort = listener.collect(LaserScan, "/scan", qos_profile_sensor_data)
    with driving_bridge(ros_domain, scan_qos="reliable"):
        listener.wait_until(lambda: bool(reliable) and bool(best_effort))
    assert len(reliable[0].ranges) == 360


def test_each_scan_can_be_transformed_to_the_map_at_its_own_time(ros_domain: int, listener: Listener) -> None:
    scans = listener.collect(LaserScan, "/scan", qos_profile_sensor_data)
    moving, standing = listener.collect(TFMessage, "/tf", TF_QOS), listener.collect(TFMessage, "/tf_static", LATCHED)
    truth = listener.collect(Odometry, "/ground_truth", RELIABLE)
    settings = {"tf": "map", "ground_truth": True, "lidar_x": 0.1, "lidar_yaw": 0.5, "drift_linear": 0.1}
    with driving_bridge(ros_domain, **settings):
        listener.wait_until(lambda: len(scans) > 3 and len(moving) > 20 and bool(standing) and len(truth) > 20)
    parents: dict[str, set[str]] = {}
    transforms_at: dict[tuple[int, int], dict[str, Any]] = {}
    for message in (*moving, *standing):
        for transform in message.transforms:
            parents.setdefault(transform.child_frame_id, set()).add(transform.header.frame_id)
            transforms_at.setdefault(stamp(transform.header), {})[transform.child_frame_id] = transform
    assert parents == {"laser": {"base_link"}, "base_link": {"odom"}, "odom": {"map"}}  # one parent each: a tree
    received = [stamp(message.transforms[0].header) for message in moving]
    expected = [scan for scan in scans if received[0] <= stamp(scan.header) <= received[-1]]
    assert expected
    true_poses = {stamp(odometry.header): odometry for odometry in truth}
    mount = planar_matrix(standing[0].transforms[0])
    assert mount[:2, 2] == pytest.approx([0.1, 0.0])
    for scan in expected:
        frames = transforms_at[stamp(scan.header)]
        assert scan.header.frame_id == "laser"
        base = planar_matrix(frames["odom"]) @ planar_matrix(frames["base_link"])
        if stamp(scan.header) in true_poses:  # the subscription may begin later than that of the frames
            true_pose = true_poses[stamp(scan.header)]
            position = true_pose.pose.pose.position
            assert base[:2, 2] == pytest.approx([position.x, position.y], abs=1e-9)
            assert true_pose.header.frame_id == "map"
        x, y = points_of(scan, base @ mount)
        assert np.minimum(abs(abs(x) - 3.0), abs(abs(y) - 2.0)) == pytest.approx(0.0, abs=1e-5)  # on one of the walls


def test_the_frames_of_odometry_reach_a_late_subscription(ros_domain: int, listener: Listener) -> None:
    moving, odometry = listener.collect(TFMessage, "/tf", TF_QOS), listener.collect(Odometry, "/odom", RELIABLE)
    with driving_bridge(ros_domain, tf="odom", lidar_x=0.1, drift_linear=0.1):
        listener.wait_until(lambda: len(moving) > 20 and len(odometry) > 20)
        standing = listener.collect(TFMessage, "/tf_static", LATCHED)
        listener.wait_until(lambda: bool(standing))
    transforms = [transform for message in (*moving, *standing) for transform in message.transforms]
    edges = {(transform.header.frame_id, transform.child_frame_id) for transform in transforms}
    assert edges == {("odom", "base_link"), ("base_link", "laser")}
    poses = {stamp(message.header): message.pose.pose for message in odometry}
    common = [message.transforms[0] for message in moving if stamp(message.transforms[0].header) in poses]
    assert common
    for transform in common:
        pose, moved = poses[stamp(transform.header)], transform.transform
        assert (moved.translation.x, moved.translation.y) == (pose.position.x, pose.position.y)
        assert moved.rotation == pose.orientation


def test_a_late_subscription_gets_the_map(ros_domain: int, listener: Listener) -> None:
    with driving_bridge(ros_domain, publish_map=True, map_resolution=0.1):
        maps = listener.collect(OccupancyGrid, "/map", LATCHED)
        listener.wait_until(lambda: bool(maps))
    grid, (received,) = grid_of(load_world(WORLD), 0.1), maps
    assert (received.info.height, received.info.width) == grid.cells.shape
    assert received.header.frame_id == "map"
    assert received.info.resolution == pytest.approx(0.1)
    assert (received.info.origin.position.x, received.info.origin.position.y) == (grid.x, grid.y)
    assert received.info.origin.orientation.w == 1.0
    assert np.array_equal(np.array(received.data, dtype=np.int8).reshape(grid.cells.shape), grid.cells)


def test_without_the_options_only_scan_odom_and_clock_are_published(ros_domain: int) -> None:
    with driving_bridge(ros_domain) as bridge:
        topics = {name for name, _ in bridge._node.get_publisher_names_and_types_by_node("simulator", "/")}
    assert topics == {"/clock", "/odom", "/scan", "/parameter_events", "/rosout"}
