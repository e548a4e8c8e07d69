"""Writes a rosbag2 folder with one mcap file, using the library `rosbags` instead of ROS."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from sim.export.exceptions import ExportError
from sim.lidar import Scan
from sim.pose import Command
from sim.recording import Recording
from sim.rows import scan_at, state_at
from sim.state import RobotState

PLANAR = (0, 1, 5)  # x, y and yaw among the six axes of a covariance

Row = tuple[int, int, str, str, Any]
"""The time in ns, the order among rows of the same time, the topic, the type, and the value of a message."""


def write_bag(recording: Recording, path: Path) -> Path:
    """Write `recording`; see `sim.export.to_mcap`."""
    try:
        from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError:
        raise ExportError("a rosbag2 needs the library 'rosbags': pip install 'ros2-python-course[export]'") from None
    folder = path.with_suffix("") if path.suffix == ".mcap" else path
    if folder.exists():
        raise ExportError(f"{folder}: it already exists: remove it, or choose another name")
    store = get_typestore(Stores.LATEST)  # these messages are the same in each distribution since ROS 2 Foxy
    infinite_time = QosTime(2147483647, 4294967295)

    def qos(reliability: Any, depth: int) -> Any:
        return Qos(
            history=QosHistory.KEEP_LAST,
            depth=depth,
            reliability=reliability,
            durability=QosDurability.VOLATILE,
            deadline=infinite_time,
            lifespan=infinite_time,
            liveliness=QosLiveliness.AUTOMATIC,
            liveliness_lease_duration=infinite_time,
            avoid_ros_namespace_conventions=False,
        )

    folder.parent.mkdir(parents=True, exist_ok=True)
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connections: dict[str, Any] = {}
        factory = _MessageFactory(store.types)
        for time_ns, _, topic, kind, value in _rows(recording):
            if topic not in connections:
                reliability = QosReliability.BEST_EFFORT if kind.endswith("LaserScan") else QosReliability.RELIABLE
                profile = qos(reliability, 5 if kind.endswith("LaserScan") else 10)
                connections[topic] = writer.add_connection(topic, kind, typestore=store, offered_qos_profiles=[profile])
            message = factory.message(kind, value, topic.rpartition("/")[0].strip("/"))
            writer.write(connections[topic], time_ns, store.serialize_cdr(message, kind))
    return folder


def _rows(recording: Recording) -> Iterator[Row]:
    """Yield all messages, ordered by time. Those of one time are in the order clock, command, odometry, scan."""
    return heapq.merge(*_streams(recording), key=lambda row: row[:2])


def _streams(recording: Recording) -> Iterator[Iterator[Row]]:
    times = recording.times_ns.tolist()
    yield ((time, 0, "/clock", "rosgraph_msgs/msg/Clock", time) for time in times)
    for index, spec in enumerate(recording.simulation.robots):
        prefix = f"/{spec.namespace}" if spec.namespace else ""
        yield _commands(recording, index, f"{prefix}/cmd_vel")
        yield _odometry(recording, index, f"{prefix}/odom")
        yield _scans(recording, index, f"{prefix}/scan")


def _commands(recording: Recording, index: int, topic: str) -> Iterator[Row]:
    """Yield the commands. Each is in the row of the state it led to, and was sent at the time of the previous row."""
    for row in range(1, len(recording)):
        linear, angular = recording.commands[row, index].tolist()
        if not np.isnan(linear):
            yield int(recording.times_ns[row - 1]), 1, topic, "geometry_msgs/msg/Twist", Command(linear, angular)


def _odometry(recording: Recording, index: int, topic: str) -> Iterator[Row]:
    for row in range(len(recording)):
        state = state_at(recording, row)
        yield state.time_ns, 2, topic, "nav_msgs/msg/Odometry", (state.time_ns, state.robots[index])


def _scans(recording: Recording, index: int, topic: str) -> Iterator[Row]:
    for number, row in enumerate(recording.scans[index].rows.tolist()):
        scan = scan_at(recording, index, number)
        yield int(recording.times_ns[row]), 3, topic, "sensor_msgs/msg/LaserScan", scan


class _MessageFactory:
    """Creates messages of the typestore's classes, which are not those of rclpy."""

    def __init__(self, types: Any) -> None:
        self._types = types

    def message(self, kind: str, value: Any, namespace: str) -> Any:
        prefix = f"{namespace}/" if namespace else ""
        if kind == "rosgraph_msgs/msg/Clock":
            return self._types[kind](clock=self._time(value))
        if kind == "geometry_msgs/msg/Twist":
            return self._twist(value)
        if kind == "nav_msgs/msg/Odometry":
            time_ns, robot = value
            return self._odometry(time_ns, robot, prefix)
        return self._scan(value, prefix)

    def _time(self, time_ns: int) -> Any:
        return self._types["builtin_interfaces/msg/Time"](*divmod(time_ns, 1_000_000_000))

    def _header(self, time_ns: int, frame: str) -> Any:
        return self._types["std_msgs/msg/Header"](self._time(time_ns), frame)

    def _vector(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Any:
        return self._types["geometry_msgs/msg/Vector3"](x, y, z)

    def _twist(self, command: Command) -> Any:
        return self._types["geometry_msgs/msg/Twist"](self._vector(x=command.linear), self._vector(z=command.angular))

    def _odometry(self, time_ns: int, robot: RobotState, prefix: str) -> Any:
        types = self._types
        odometry = robot.odometry
        covariance = np.zeros((6, 6))
        covariance[np.ix_(PLANAR, PLANAR)] = np.reshape(robot.covariance, (3, 3))
        turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, np.sin(odometry.theta / 2), np.cos(odometry.theta / 2))
        pose = types["geometry_msgs/msg/Pose"](types["geometry_msgs/msg/Point"](odometry.x, odometry.y, 0.0), turn)
        return types["nav_msgs/msg/Odometry"](
            self._header(time_ns, f"{prefix}odom"),
            f"{prefix}base_link",
            types["geometry_msgs/msg/PoseWithCovariance"](pose, covariance.ravel()),
            types["geometry_msgs/msg/TwistWithCovariance"](self._twist(robot.velocity), np.zeros(36)),
        )

    def _scan(self, scan: Scan, prefix: str) -> Any:
        return self._types["sensor_msgs/msg/LaserScan"](
            self._header(scan.stamp_ns, f"{prefix}{scan.frame_id}"),
            scan.angle_min,
            scan.angle_max,
            scan.angle_increment,
            scan.time_increment,
            scan.scan_time,
            scan.range_min,
            scan.range_max,
            scan.ranges,
            scan.intensities,
        )
