"""Optional topics that RViz, nav2 and slam_toolbox need besides a scan: frames on /tf, a map, and the true pose.

The frames are map, odom and base_link, as in REP 105, and laser for the lidar. With several robots, each has its own
frames, with its namespace as a prefix, below one map.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sim.bridge.messages import grid_to_msg, map_to_odom, transform_to_msg, truth_to_msg
from sim.lidar import Scan
from sim.maps.grid import grid_of
from sim.simulation import Simulation, State

LATCHED = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""The profile of map_server and tf2: late subscriptions also receive the last message."""

TF_QOS = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)
"""The profile of tf2's broadcaster."""

FRAMES = ("base_link", "laser")
"""The frames of a robot that do not move relative to each other."""


class Localization:
    """Publishes the topics that are enabled in the settings."""

    def __init__(
        self, node: Node, simulation: Simulation, prefixes: Mapping[str, str], values: Mapping[str, Any]
    ) -> None:
        self._tf_mode, self._prefixes = values["tf"], prefixes
        self._tf_publisher = None if self._tf_mode == "none" else node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._truth_publishers = {
            name: node.create_publisher(Odometry, f"{prefix}ground_truth", 10)
            for name, prefix in prefixes.items()
            if values["ground_truth"]
        }
        self._latched_publishers: list[Any] = []  # latched publishers, which send their message only while they exist
        if self._tf_publisher is not None:
            self._latch(node, TFMessage, "/tf_static", TFMessage(transforms=self._lidars(simulation)))
        if values["publish_map"]:
            self._latch(node, OccupancyGrid, "/map", grid_to_msg(grid_of(simulation.world, values["map_resolution"])))

    def publish(self, state: State, odometry: tuple[str, ...], scans: Mapping[str, Scan]) -> None:
        """Send the frames and the true pose of each robot that sends odometry or a scan in this state."""
        transforms = []
        for robot in state.robots:
            if robot.name not in odometry and robot.name not in scans:
                continue
            prefix = self._prefixes[robot.name]
            if robot.name in self._truth_publishers:
                self._truth_publishers[robot.name].publish(truth_to_msg(robot, state.time_ns, f"{prefix}base_link"))
            if self._tf_mode == "map":
                transforms.append(transform_to_msg(map_to_odom(robot), state.time_ns, "map", f"{prefix}odom"))
            frames = (f"{prefix}odom", f"{prefix}base_link")
            transforms.append(transform_to_msg(robot.odometry, state.time_ns, *frames))
        if self._tf_publisher is not None and transforms:
            self._tf_publisher.publish(TFMessage(transforms=transforms))

    def _lidars(self, simulation: Simulation) -> list[Any]:
        """Return the pose of each lidar on its robot."""
        return [
            transform_to_msg(spec.lidar.mount, 0, *(f"{self._prefixes[spec.name]}{frame}" for frame in FRAMES))
            for spec in simulation.robots
            if spec.lidar is not None
        ]

    def _latch(self, node: Node, kind: Any, topic: str, message: Any) -> None:
        publisher = node.create_publisher(kind, topic, LATCHED)
        publisher.publish(message)
        self._latched_publishers.append(publisher)
