"""The node's parameters, in one table: each with its type, default, range and description."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from sim.exceptions import SpecError
from sim.lidar import LDS_01, RPLIDAR_A1, UTM_30LX, LidarSpec
from sim.maps import load
from sim.pose import Pose
from sim.robot import OdometryDrift, RobotSpec
from sim.simulation import Simulation

LIDARS = {"lds_01": LDS_01, "rplidar_a1": RPLIDAR_A1, "utm_30lx": UTM_30LX}


@dataclass(frozen=True)
class Setting:
    """A parameter. `low` and `high` are the inclusive range of a number. If it is `live`, it may change at run time."""

    name: str
    default: Any
    description: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    live: bool = False

    def descriptor(self) -> ParameterDescriptor:
        """Return the description that `ros2 param describe` shows."""
        descriptor = ParameterDescriptor(description=self.description, read_only=not self.live)
        if self.choices:
            descriptor.additional_constraints = f"one of: {', '.join(self.choices)}"
        if isinstance(self.default, float) and self.low is not None and self.high is not None:
            descriptor.floating_point_range = [FloatingPointRange(from_value=self.low, to_value=self.high)]
        elif isinstance(self.default, int) and self.low is not None and self.high is not None:
            descriptor.integer_range = [IntegerRange(from_value=int(self.low), to_value=int(self.high))]
        return descriptor


_ROBOT, _LIDAR = RobotSpec(), LDS_01

SETTINGS = (
    Setting("world", "", "The world: a world's YAML file, or that of a ROS map."),
    Setting("robots", [""], "The robots' namespaces, one robot each; [''] is one robot without a namespace."),
    Setting("seed", 0, "The seed of all noise, drop-outs, drift and moving obstacles.", 0, 2**53),
    Setting("engine", "auto", "The engine; all compute the same bits.", choices=("auto", "numpy", "numba")),
    Setting("speed", 1.0, "Simulated seconds per second of real time.", 0.01, 1000.0, live=True),
    Setting("recording", "", "The file to which the run's recording is written when the node ends; '' writes none."),
    Setting("start_paused", False, "Start paused, waiting for ~/pause or ~/step."),
    Setting("tick", 0.02, "The physics period in s.", 0.0001, 1.0),
    Setting("step_time", 0.1, "The time that one call of ~/step simulates, in s.", 0.0001, 60.0, live=True),
    Setting("odometry_rate", 50.0, "Odometry messages per simulated second.", 0.1, 1000.0),
    Setting(
        "scan_qos",
        "sensor_data",
        "QoS of scan; 'reliable' matches all subscriptions, including those that require it.",
        choices=("sensor_data", "reliable"),
    ),
    Setting(
        "tf",
        "none",
        "Frames on /tf and /tf_static: 'odom' sends odom, base_link, laser; 'map' also map, as a perfect localization.",
        choices=("none", "odom", "map"),
    ),
    Setting("publish_map", False, "Publish the world on /map, latched."),
    Setting("map_resolution", 0.05, "The side of a cell of /map in m.", 0.01, 1.0),
    Setting("ground_truth", False, "Publish ground_truth, the true pose and velocity in frame map."),
    Setting("stamped_cmd_vel", False, "Take geometry_msgs/TwistStamped on cmd_vel instead of Twist."),
    Setting("lidar", "lds_01", "The model of the lidar.", choices=tuple(LIDARS)),
    Setting("lidar_rate", 0.0, "Scans per simulated second; 0 is the lidar's own rate.", 0.0, 1000.0),
    Setting("lidar_x", 0.0, "The position of frame laser in base_link, forward, in m.", -10.0, 10.0),
    Setting("lidar_y", 0.0, "The position of frame laser in base_link, to the left, in m.", -10.0, 10.0),
    Setting("lidar_yaw", 0.0, "The rotation of frame laser in base_link, anticlockwise, in rad.", -6.3, 6.3),
    Setting("lidar_noise", 0.0, "Standard deviation of a range in m.", 0.0, 10.0),
    Setting("lidar_dropout", 0.0, "The probability that a beam is lost.", 0.0, 1.0),
    Setting("lidar_skew", False, "Take the beams one after the other, while the robot moves."),
    Setting("radius", _ROBOT.radius, "The robot's radius in m.", 0.01, 10.0),
    Setting("max_linear", _ROBOT.max_linear, "The top speed in m/s.", 0.0, 100.0),
    Setting("max_angular", _ROBOT.max_angular, "The top turning speed in rad/s.", 0.0, 100.0),
    Setting("max_linear_acceleration", _ROBOT.max_linear_acceleration, "In m/s².", 0.001, 1000.0),
    Setting("max_angular_acceleration", _ROBOT.max_angular_acceleration, "In rad/s².", 0.001, 1000.0),
    Setting(
        "watchdog", _ROBOT.watchdog, "Simulated time without a command after which the robot stops, in s.", 0.01, 1e6
    ),
    Setting("on_collision", "stop", "The effect of a contact on the motion.", choices=("stop", "slide")),
    Setting("drift_linear", 0.0, "Odometry: standard deviation in m for a metre driven.", 0.0, 10.0),
    Setting("drift_angular", 0.0, "Odometry: standard deviation in rad for a radian turned.", 0.0, 10.0),
    Setting("drift_veer", 0.0, "Odometry: standard deviation in rad for a metre driven.", 0.0, 10.0),
)


def declare(node: Node) -> dict[str, Any]:
    """Declare every setting on `node` and return the values.

    Raises:
        rclpy.exceptions.InvalidParameterValueException: a value is out of range.
        rclpy.exceptions.InvalidParameterTypeException: a value has the wrong type.
        SpecError: a value is not one of the choices.
    """
    values = {}
    for setting in SETTINGS:
        value = node.declare_parameter(setting.name, setting.default, setting.descriptor()).value
        if setting.choices and value not in setting.choices:
            raise SpecError(f"parameter {setting.name!r} is {value!r}: choose one of {', '.join(setting.choices)}")
        values[setting.name] = value
    return values


def simulation_of(values: dict[str, Any]) -> Simulation:
    """Return the simulation that the values describe.

    Raises:
        WorldError: the world cannot be read.
        SpecError: the values contradict each other.
    """
    if not values["world"]:
        raise SpecError("parameter 'world' is empty: give the path of a world's YAML file")
    world = load(Path(values["world"]))
    namespaces = [namespace.strip("/") for namespace in values["robots"]]
    if len(set(namespaces)) != len(namespaces):
        raise SpecError(f"parameter 'robots' names a robot twice: {', '.join(namespaces)}")
    if len(namespaces) > len(world.starts):
        raise SpecError(
            f"{len(namespaces)} robots, but the world {world.name!r} has {len(world.starts)} start poses: "
            "add some under 'starts:', or ask for fewer robots"
        )
    robots = tuple(
        RobotSpec(
            name=namespace or "robot",
            namespace=namespace,
            radius=values["radius"],
            max_linear=values["max_linear"],
            max_angular=values["max_angular"],
            max_linear_acceleration=values["max_linear_acceleration"],
            max_angular_acceleration=values["max_angular_acceleration"],
            watchdog=values["watchdog"],
            on_collision=values["on_collision"],
            drift=OdometryDrift(values["drift_linear"], values["drift_angular"], values["drift_veer"]),
            lidar=_lidar(values),
        )
        for namespace in namespaces
    )
    return Simulation(world, robots, seed=values["seed"], tick=values["tick"], engine=values["engine"])


def _lidar(values: dict[str, Any]) -> LidarSpec:
    preset = LIDARS[values["lidar"]]
    return replace(
        preset,
        rate=values["lidar_rate"] or preset.rate,
        noise=values["lidar_noise"],
        dropout=values["lidar_dropout"],
        skew=values["lidar_skew"],
        mount=Pose(values["lidar_x"], values["lidar_y"], values["lidar_yaw"]),
    )
