"""The value of a parameter, as a node's services answer it. A node may answer anything."""

from __future__ import annotations

from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue
from rclpy.parameter import parameter_value_to_python

from autograder.submission.reading import reading

KNOWN = range(ParameterType.PARAMETER_NOT_SET, ParameterType.PARAMETER_STRING_ARRAY + 1)


def value_of(answered: ParameterValue, name: str) -> Any:
    """Return the value of the parameter `name` that a node answered; None for one that is not set.

    Raises:
        StudentError: the answer has a type that ROS does not know.
    """
    with reading(f"What your node answered about its parameter {name}"):
        if answered.type not in KNOWN:
            raise ValueError(f"{answered.type} is not a type of a parameter")
        return parameter_value_to_python(answered)
