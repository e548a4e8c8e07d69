"""Reads the value of a parameter from a node's answer, which may contain anything."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.parameter import parameter_value_to_python

from autograder.submission.reading import reading

KNOWN_TYPES = range(ParameterType.PARAMETER_NOT_SET, ParameterType.PARAMETER_STRING_ARRAY + 1)


def value_of(answer: ParameterValue, name: str) -> Any:
    """Return the value of the parameter `name` from a node's answer, or None if it is not set.

    Raises:
        StudentError: the answer has a type that ROS does not know.
    """
    with reading(f"Your node's answer about its parameter {name}"):
        if answer.type not in KNOWN_TYPES:
            raise ValueError(f"{answer.type} is not a parameter type")
        return parameter_value_to_python(answer)
