"""The contract of the exercises, as data, and names that several checks use."""

from __future__ import annotations

from dataclasses import dataclass

from rcl_interfaces.msg import ParameterType

from autograder.checking.probes import parameters

PACKAGE = "my_robot_package"
EXECUTABLE = "configured_node"
NODE = "/configured_node"
FLEET = "fleet_params.yaml"


@dataclass(frozen=True)
class Specification:
    """A parameter as the exercise specifies it.

    Attributes:
        type: a constant of ParameterType.
        default: its value if it is not set.
        low: the lowest value; None if there is no range.
        high: the highest value; None if there is no range.
        unit: the unit that its description must name; '' if there is none.
    """

    type: int
    default: parameters.Value
    low: float | None = None
    high: float | None = None
    unit: str = ""


DOUBLE = ParameterType.PARAMETER_DOUBLE
SPECIFICATIONS = {
    "robot_name": Specification(ParameterType.PARAMETER_STRING, "DefaultRobot"),
    "max_linear_velocity": Specification(DOUBLE, 0.3, 0.0, 1.0, "m/s"),
    "safety_distance": Specification(DOUBLE, 0.5, 0.2, 3.0, "m"),
    "slow_distance": Specification(DOUBLE, 1.0, 0.2, 3.0, "m"),
    "control_frequency": Specification(DOUBLE, 10.0, 1.0, 50.0, "Hz"),
    "battery_threshold": Specification(ParameterType.PARAMETER_INTEGER, 20, 0, 100, "percent"),
}
TABLE_ROWS = tuple(SPECIFICATIONS)  # the ids of the requirements in the table of parameters
FLEET_ROWS = tuple(f"fleet-{name.replace('_', '-')}" for name in SPECIFICATIONS)  # those in the table of robots
DEFAULTS = {name: specification.default for name, specification in SPECIFICATIONS.items()}
CHANGEABLE = {name: value for name, value in DEFAULTS.items() if name != "robot_name"}

# The values that every robot of the fleet has, and the values of single robots.
SHARED: dict[str, parameters.Value] = {
    "max_linear_velocity": 0.3,
    "safety_distance": 0.6,
    "slow_distance": 1.5,
    "battery_threshold": 25,
}
PER_ROBOT: dict[str, dict[str, parameters.Value]] = {
    "scout": {"robot_name": "Scout", "max_linear_velocity": 0.6},
    "porter": {"robot_name": "Porter", "safety_distance": 1.0, "control_frequency": 20.0},
}

PARAMETERS = "https://docs.ros.org/en/jazzy/Concepts/Basic/About-Parameters.html"
IN_A_CLASS = "https://docs.ros.org/en/jazzy/Tutorials/Beginner-Client-Libraries/Using-Parameters-In-A-Class-Python.html"
ARGUMENTS = "https://docs.ros.org/en/jazzy/How-To-Guides/Node-arguments.html"


def fleet_values(name: str) -> dict[str, parameters.Value]:
    """Return all values of the robot with this name if it is started with the fleet's parameter file."""
    return {**DEFAULTS, **SHARED, **PER_ROBOT.get(name, {})}
