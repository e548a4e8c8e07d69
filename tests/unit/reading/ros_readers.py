"""The readers of messages from a student's nodes, and how the worker uses each message."""

from __future__ import annotations

import array
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from action_msgs.msg import GoalStatusArray
from geometry_msgs.msg import Twist
from hypothesis import strategies as st
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Log, ParameterDescriptor, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from sensor_msgs.msg import BatteryState, JointState, LaserScan
from std_msgs.msg import String

from autograder.building.interfaces.loading import classes
from autograder.building.interfaces.messages import from_bytes
from autograder.harness.drive import _command, _move
from autograder.harness.goals import Actions, Goal, ReceivedMessage
from autograder.harness.message_text import format_message
from autograder.harness.parameter_values import value_of
from autograder.probes import parameters
from sim import Recorder, Simulation, load_world, start
from tests.unit.reading.generated import altered
from tests.unit.reading.reader import Reader

KINDS = (
    *(Twist, Odometry, LaserScan, BatteryState, JointState, String, Log, GoalStatusArray, ParameterDescriptor),
    *(GetParameters.Response, SetParametersAtomically.Response),
)
FLOATS = st.floats(width=32) | st.sampled_from((float("nan"), float("inf"), -float("inf"), 3.4e38, -0.0))
DOUBLES = st.floats() | st.sampled_from((float("nan"), float("inf"), 1e308, 5e-324))
TEXTS = st.text(st.sampled_from("ab/_~: \n\0\x1b\u202eé9"), max_size=30) | st.just("x" * 3000)
WORLD = Path(__file__).parents[3] / "assets" / "worlds"


def _integers(kind: str) -> st.SearchStrategy[int]:
    bits = int(re.sub(r"\D", "", kind))
    return st.integers(0, 2**bits - 1) if kind.startswith("u") else st.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)


def _values(kind: str) -> st.SearchStrategy[Any]:
    """Return a strategy for values of a field, by its type as rosidl writes it."""
    if match := re.fullmatch(r"sequence<([^,>]+)(?:, (\d+))?>", kind):
        return st.lists(_values(match[1]), max_size=min(int(match[2] or 4), 4))
    if match := re.fullmatch(r"(.+)\[(\d+)\]", kind):
        return st.lists(_values(match[1]), min_size=int(match[2]), max_size=int(match[2]))
    if kind.startswith("string"):
        return TEXTS
    plain = {"boolean": st.booleans(), "float": FLOATS, "double": DOUBLES, "octet": st.binary(min_size=1, max_size=1)}
    if kind in plain:
        return plain[kind]
    return _integers(kind) if re.fullmatch(r"u?int\d+", kind) else messages(_class(kind))


def _class(kind: str) -> Any:
    package, name = kind.split("/")
    return getattr(__import__(f"{package}.msg", fromlist=["msg"]), name)


def messages(kind: Any) -> st.SearchStrategy[Any]:
    """Return a strategy for messages of a type: all that its fields can hold."""
    fields = {name: _values(of) for name, of in kind.get_fields_and_field_types().items()}
    return st.fixed_dictionaries(fields).map(lambda values: _message(kind, values))


def _message(kind: Any, values: dict[str, Any]) -> Any:
    message = kind()
    for name, value in values.items():
        current = getattr(message, name)
        if isinstance(current, array.array):
            value = array.array(current.typecode, value)
        elif isinstance(current, np.ndarray):
            value = np.array(value, current.dtype)
        setattr(message, name, value)
    return message


def drive_step(message: Twist, folder: Path) -> object:
    """Drive a step with a command, as a harness does."""
    simulation = Simulation(load_world(WORLD / "empty_room.yaml"))
    state = start(simulation)
    return _move(simulation, state, _command(ReceivedMessage(0.1, message)), 200_000_000, Recorder(simulation, state))


def describe_parameter(answer: ParameterValue, folder: Path) -> object:
    """Read a node's answer about a parameter, compare it and put it into words."""
    values = {"speed": value_of(answer, "speed")}
    declared = parameters.as_declared({"speed": 3.0}, values)
    return (
        parameters.differences(values, {"speed": 0.5}),
        parameters.override_arguments(declared),
        parameters.same(1.0, 2.0),
    )


def follow_goal(message: GoalStatusArray, folder: Path) -> None:
    """Take the states of goals; one of them is the grader's."""
    node: Any = SimpleNamespace(on_exchange=lambda *exchange: None)
    actions = Actions(node, lambda arrived_ns: 0.1)
    actions._goals[bytes(16)] = Goal()
    actions._on_status(message, 0)


def show(message: Any, folder: Path) -> str:
    """Format a message for the feedback."""
    return format_message(message)


def _own_type() -> Any:
    inner, status = ("msg/Inner.msg", "bool flag\nstring<=3 word\n"), ("msg/Status.msg", "string a\nInner[] many\n")
    return classes((("wheels_msgs", (inner, status)),)).msg.Status


READERS: dict[str, Reader] = {
    "command of a robot": Reader(drive_step, messages(Twist)),
    "answer about a parameter": Reader(
        describe_parameter,
        messages(ParameterValue),
        (ParameterValue(type=200), ParameterValue(type=3, double_value=float("nan")), ParameterValue(type=9)),
    ),
    "states of goals": Reader(follow_goal, messages(GoalStatusArray)),
    "message that is shown": Reader(show, st.one_of(*map(messages, KINDS))),
    "bytes of a message of the student's own type": Reader(
        lambda data, folder: format_message(from_bytes(_own_type(), data)),
        altered(bytes(40), b"\x01\0\0\0\x02\0\0\0a\0" + bytes(30)) | st.binary(max_size=60),
        refuses=(ValueError,),
    ),
}
