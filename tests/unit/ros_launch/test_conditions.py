"""Conditions: texts that are true, texts that are false, and texts that are refused."""

from __future__ import annotations

from typing import Any

import pytest
from launch import LaunchContext
from launch.actions import LogInfo
from launch.conditions import (
    IfCondition,
    InvalidConditionExpressionError,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    UnlessCondition,
)
from launch.substitutions import LaunchConfiguration, PythonExpression


@pytest.mark.parametrize("text", ["true", "True", "1", " TRUE "])
@pytest.mark.parametrize("negate", [False, True])
def test_true_and_one_are_true_conditions(context: LaunchContext, text: str, negate: bool) -> None:
    condition = UnlessCondition(text) if negate else IfCondition(text)
    assert condition.evaluate(context) is not negate


@pytest.mark.parametrize("text", ["false", "False", "0"])
def test_false_and_zero_are_false_conditions(context: LaunchContext, text: str) -> None:
    assert IfCondition(text).evaluate(context) is False
    assert UnlessCondition(text).evaluate(context) is True


def test_a_condition_is_evaluated_in_the_context(context: LaunchContext) -> None:
    condition = IfCondition(PythonExpression(["'", LaunchConfiguration("robot"), "' == 'r2'"]))
    assert condition.evaluate(context)
    context.launch_configurations["robot"] = "c3"
    assert not condition.evaluate(context)


@pytest.mark.parametrize("text", ["yes", "", "2", "None"])
def test_other_texts_are_errors(context: LaunchContext, text: str) -> None:
    with pytest.raises(InvalidConditionExpressionError, match=f"expected one of .*true.* but got '{text.lower()}'"):
        IfCondition(text).evaluate(context)


@pytest.mark.parametrize(
    ("name", "expected", "equal"),
    [
        ("robot", "r2", True),
        ("robot", "c3", False),
        ("missing", None, True),
        ("robot", None, False),
        ("missing", "", False),
    ],
)
def test_a_launch_configuration_is_compared_with_a_text(
    context: LaunchContext, name: str, expected: Any, equal: bool
) -> None:
    with pytest.warns(UserWarning, match="is deprecated: use IfCondition with EqualsSubstitution"):
        assert LaunchConfigurationEquals(name, expected).evaluate(context) is equal
    with pytest.warns(UserWarning, match="is deprecated: use IfCondition with EqualsSubstitution"):
        assert LaunchConfigurationNotEquals(name, expected).evaluate(context) is not equal


def test_a_value_that_is_not_a_condition_is_rejected_at_once() -> None:
    with pytest.raises(TypeError, match=r"LogInfo: condition must be a launch.Condition such as IfCondition.*got str"):
        LogInfo(msg="", condition="true")


def test_a_condition_describes_itself(context: LaunchContext) -> None:
    condition = IfCondition("true")
    assert condition.describe() == repr(condition)
