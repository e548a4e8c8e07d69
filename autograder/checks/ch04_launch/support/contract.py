"""The contract of the three exercises, and the names that the checks use."""

from __future__ import annotations

from autograder.checking.probes import parameters

PACKAGE = "my_robot_bringup"
ROBOT = "robot.launch.py"
FLEET = "two_robots.launch.py"
SAFE = "safe_start.launch.py"
CONFIG = "config/robot.yaml"

DRIVER, REPORTER = "/driver", "/reporter"
SHARED = "/fleet/status"
ROBOT_NAME, SPEED = "robot1", 0.2  # the defaults of robot.launch.py
NODE_DEFAULTS: dict[str, dict[str, parameters.Value]] = {  # the parameters of the nodes without a parameters file
    DRIVER: {"speed": 0.1, "turn_rate": 0.0},
    REPORTER: {"robot_name": "nobody", "report_period": 1.0},
}
FIRST, SECOND = "robot1", "robot2"  # the defaults of two_robots.launch.py

LAUNCH = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Launch/Creating-Launch-Files.html"
SUBSTITUTIONS = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Launch/Using-Substitutions.html"
EVENTS = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Launch/Using-Event-Handlers.html"
LARGE = "https://docs.ros.org/en/jazzy/Tutorials/Intermediate/Launch/Using-ROS2-Launch-For-Large-Projects.html"


def nodes_in_namespaces(*namespaces: str) -> list[str]:
    """Return the full names of the nodes of robots in these namespaces."""
    return sorted(f"/{namespace}{node}" for namespace in namespaces for node in (DRIVER, REPORTER))
