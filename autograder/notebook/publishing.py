"""Plans the additional messages of a drive: a function in the notebook returns them for each step.

The function runs in the notebook's kernel before the drive, because the driving process must not run a notebook's code.
It therefore knows the time, but not what the robot does. Its messages are sent as serialized ROS messages.
"""

from __future__ import annotations

import base64
import importlib
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from autograder.exceptions import UsageError

STEP_SECONDS = 0.1  # the ROS time between two calls, which is also the time between two scans of the simulator
RESERVED_TOPICS = ("/scan", "/odom", "/clock", "/cmd_vel")  # topics of the simulator and of the controlling program
_TOPIC = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+")

EachStep = Callable[[float], "Mapping[str, Any] | None"]
"""Takes the seconds since the start, and returns the messages to publish by topic, or None."""


def plan_messages(each_step: EachStep, seconds: float, workspace: Path) -> dict[str, Any]:
    """Call a function for each step of a drive, and return its messages as JSON: types by topic, and steps.

    Args:
        each_step: the function.
        seconds: the length of the drive in ROS time.
        workspace: the colcon workspace of the program.

    Raises:
        UsageError: a returned value cannot be published. The message says when it was returned and what to do.
    """
    from rclpy.serialization import serialize_message

    types: dict[str, str] = {}
    steps: list[dict[str, str]] = []
    for number in range(1, round(seconds / STEP_SECONDS) + 1):
        time = round(number * STEP_SECONDS, 1)
        messages = each_step(time)
        if not isinstance(messages or {}, Mapping):
            raise UsageError(
                f"at {time} s, each_step returned {messages!r}: return messages by topic, such as {{'/mode': String()}}"
            )
        step = {}
        for name, message in (messages or {}).items():
            topic = "/" + str(name).lstrip("/")
            kind = _type_of(topic, message, workspace)
            if types.setdefault(topic, kind) != kind:
                raise UsageError(f"at {time} s, each_step returned a {kind} for {topic}, and before a {types[topic]}")
            step[topic] = base64.b64encode(serialize_message(message)).decode("ascii")
        steps.append(step)
    return {"types": types, "steps": steps}


def types_of(plan: Mapping[str, Any]) -> dict[str, type]:
    """Return the class of the messages on each topic of a plan."""
    parts = {topic: kind.split("/") for topic, kind in plan["types"].items()}
    return {topic: getattr(importlib.import_module(f"{part[0]}.msg"), part[-1]) for topic, part in parts.items()}


def messages_at(plan: Mapping[str, Any], types: Mapping[str, type], time_ns: int) -> dict[str, Any]:
    """Return a plan's messages for a time in ns since the start. Between two steps, there are none."""
    from rclpy.serialization import deserialize_message

    number, remainder = divmod(time_ns, round(STEP_SECONDS * 1e9))
    step = plan["steps"][number - 1] if remainder == 0 and 0 < number <= len(plan["steps"]) else {}
    return {topic: deserialize_message(base64.b64decode(text), types[topic]) for topic, text in step.items()}


def _type_of(topic: str, message: Any, workspace: Path) -> str:
    """Return the ROS name of a message's type. Raises UsageError if the message cannot be published on this topic."""
    if not _TOPIC.fullmatch(topic):
        raise UsageError(f"each_step names the topic {topic!r}, which is not a valid topic name")
    if topic in RESERVED_TOPICS:
        raise UsageError(f"each_step cannot publish on {topic}: the simulator and your program use it")
    package, _, _ = type(message).__module__.partition(".")
    if not hasattr(type(message), "get_fields_and_field_types"):
        raise UsageError(f"each_step returned {message!r} for {topic}: return a message, such as String(data='fast')")
    file = getattr(sys.modules.get(package), "__file__", None)
    if file is not None and Path(file).resolve().is_relative_to(workspace.resolve()):
        raise UsageError(
            f"each_step returned a message of {package}, which your workspace builds: use an installed type"
        )
    return f"{package}/msg/{type(message).__name__}"
