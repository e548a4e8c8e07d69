"""A message of a student's node is formatted as one short line, whatever it contains."""

from __future__ import annotations

from typing import Any

import pytest
from action_msgs.srv import CancelGoal
from rcl_interfaces.msg import ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool, Trigger

from autograder.harness.message_text import format_message

REQUEST = SetParametersAtomically.Request(parameters=[Parameter("speed", value=0.35).to_parameter_msg()])
REFUSAL = SetParametersAtomically.Response(result=SetParametersResult(successful=False, reason="<script>no"))


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (REQUEST, "parameters: [{name: 'speed', value: 0.35}]"),
        (REFUSAL, "result: {successful: False, reason: '<script>no'}"),
        (SetBool.Request(data=True), "data: True"),
        (Trigger.Request(), ""),
        (GetParameters.Response(values=[ParameterValue(type=99)]), "values: [of the unknown type 99]"),
        (GetParameters.Request(names=[str(n) for n in range(9)]), "names: ['0', '1', '2', '3', '4', '5', … 9 in all]"),
        (CancelGoal.Request(), "goal_info: {stamp: {sec: 0, nanosec: 0}}"),
    ],
)
def test_a_message_is_formatted_as_one_line(message: Any, text: str) -> None:
    assert format_message(message) == text


def test_a_long_text_is_cut() -> None:
    assert len(format_message(Trigger.Response(message="x" * 1_000_000))) < 300
