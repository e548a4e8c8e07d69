"""Names and numbers in the contract of the practical question, and links that several checks use."""

from __future__ import annotations

import math
from collections.abc import Iterable
from statistics import fmean

SHEET = "assessment/answers.yaml"  # the path below src
QUESTIONS = tuple(f"q{number}" for number in range(1, 13))
LETTERS = "abcd"

PACKAGE, INTERFACES = "motor_guard", "motor_guard_interfaces"
THERMOMETER, SMOOTHER, GUARD = PROGRAMS = ("thermometer", "smoother", "guard")
LAUNCH_FILE = "motor_guard.launch.py"
LICENCE = "Apache-2.0"
TEST_DEPENDENCIES = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")
MESSAGES = {
    "msg/Temperature.msg": "builtin_interfaces/Time stamp\nfloat32 celsius\n",
    "msg/Decision.msg": "builtin_interfaces/Time stamp\nbool cooling\nfloat32 celsius\n",
}

PERIOD, MEAN, SWING = 0.5, 50.0, 20.0  # s, degrees Celsius, degrees
READINGS_PER_TURN = 20
WINDOW = 5  # readings in an average
HOT, COOL = 60.0, 50.0  # degrees Celsius: where the fan starts, and where it stops
TOLERANCE = 1e-3  # degrees: a temperature is a 32-bit float

_DOCS = "https://docs.ros.org/en/jazzy"
PACKAGES_DOC = f"{_DOCS}/How-To-Guides/Developing-a-ROS-2-Package.html"
INTERFACES_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Custom-ROS2-Interfaces.html"
NODES_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Writing-A-Simple-Py-Publisher-And-Subscriber.html"
PARAMETERS_DOC = f"{_DOCS}/Tutorials/Beginner-Client-Libraries/Using-Parameters-In-A-Class-Python.html"
LAUNCH_DOC = f"{_DOCS}/Tutorials/Intermediate/Launch/Creating-Launch-Files.html"


def reading(number: int, mean: float = MEAN, swing: float = SWING) -> float:
    """Return the thermometer's reading with this number, in degrees Celsius. Numbers start from 0."""
    return mean + swing * math.sin(math.tau * number / READINGS_PER_TURN)


def windows(readings: Iterable[float], window: int = WINDOW) -> list[list[float]]:
    """Return the readings that enter each average. A reading that is not finite enters none."""
    finite = [celsius for celsius in readings if math.isfinite(celsius)]
    return [finite[max(0, stop - window) : stop] for stop in range(1, len(finite) + 1)]


def averages(readings: Iterable[float], window: int = WINDOW) -> list[float]:
    """Return the average after each finite reading."""
    return [fmean(newest) for newest in windows(readings, window)]


def decisions(temperatures: Iterable[float], hot: float = HOT, cool: float = COOL) -> list[set[bool]]:
    """Return the allowed states of the fan after each temperature. The fan is off at first.

    Between the thresholds, both states are allowed after a temperature that is not finite.
    """
    allowed_states, states = [], {False}
    for celsius in temperatures:
        if not math.isfinite(celsius):
            allowed_states.append({True})
            states = {False, True}
            continue
        states = {True} if celsius >= hot else {False} if celsius <= cool else states
        allowed_states.append(states)
    return allowed_states
