"""Numbers and names in the exercise's contract."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

PACKAGE = "robot_navigation_tutorial"
INTERFACES = "robot_navigation_interfaces"
PROCESSOR, CONTROLLER, MONITOR = PROGRAMS = ("sensor_processor", "navigation_controller", "status_monitor")
LAUNCH_FILE = "navigation.launch.py"
CONFIG = "config/navigation.yaml"
SECTORS = "sectors"  # the module under test in the student's tests

VERSION = "0.1.0"
LICENCE = "Apache-2.0"

WATCHED_TOPICS = ("scan", "clearance", "cmd_vel")
OK, DEGRADED, FAILED = range(3)
LEVELS = ("OK", "DEGRADED", "FAILED")
REPORT_DEADLINE = 2.0  # s: a topic is silent after 1.0 s, and reports are 0.5 s apart

TOLERANCE = 0.005  # m, m/s, rad/s: 10 % of the smallest forward_speed, and above the rounding error of float32


@dataclass(frozen=True)
class BoundedParameter:
    """A parameter: its default and its range, in SI units."""

    default: float
    lowest: float
    highest: float


PARAMETERS: Mapping[str, Mapping[str, BoundedParameter]] = {
    PROCESSOR: {"half_angle": BoundedParameter(0.52, 0.1, 0.78)},
    CONTROLLER: {
        "forward_speed": BoundedParameter(0.3, 0.05, 0.5),
        "turn_speed": BoundedParameter(0.8, 0.1, 1.5),
        "safety_distance": BoundedParameter(0.6, 0.3, 2.0),
        "data_timeout": BoundedParameter(0.5, 0.2, 2.0),
    },
    MONITOR: {"silence_timeout": BoundedParameter(1.0, 0.2, 1.4)},
}

_DOCS = "https://docs.ros.org/en/jazzy"
PACKAGES_DOC = f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html"
INTERFACES_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html"
NODES_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Publisher-And-Subscriber.html"
SERVICE_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Service-And-Client.html"
SCAN_DOC = f"{_DOCS}/p/sensor_msgs/msg/LaserScan.html"
REP_117 = "https://www.ros.org/reps/rep-0117.html"
QOS_DOC = f"{_DOCS}/Concepts/Intermediate/About-Quality-of-Service-Settings.html"
LAUNCH_DOC = f"{_DOCS}/Tutorials/Intermediate/Launch/Creating-Launch-Files.html"
PARAMETERS_DOC = f"{_DOCS}/Concepts/Basic/About-Parameters.html"
TESTING_DOC = f"{_DOCS}/Tutorials/Intermediate/Testing/Python.html"


def name_of(node: str) -> str:
    """Return a node's full name."""
    return f"/{node}"
