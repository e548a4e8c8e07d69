"""Single processes: their output, and invalid arguments."""

from __future__ import annotations

from typing import Any

import launch
import pytest
from launch.actions import (
    ExecuteProcess,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
)
from launch.event_handlers import OnProcessExit, OnShutdown

pytestmark = pytest.mark.usefixtures("own_log")


def service_with(*entities: Any) -> launch.LaunchService:
    service = launch.LaunchService()
    service.include_launch_description(launch.LaunchDescription(entities))
    return service


def test_output_is_kept_if_cached_output_is_set() -> None:
    cached = ExecuteProcess(cmd=["sh", "-c", "echo out; printf err >&2"], cached_output=True)
    other = ExecuteProcess(cmd=["true"], name="other")
    service_with(cached, other).run()
    assert (cached.get_stdout(), cached.get_stderr(), cached.return_code) == ("out\n", "err", 0)
    with pytest.raises(RuntimeError, match=r"cached output must be true to be able to get stdout, proc 'other-\d+'"):
        other.get_stdout()


def test_long_output_arrives_complete_and_in_order() -> None:
    action = ExecuteProcess(cmd=["seq", "20000"], cached_output=True)
    service_with(action).run()
    assert action.get_stdout().split() == [str(number) for number in range(1, 20001)]


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"cmd": "echo hello"}, TypeError, r"cmd must be a list such as \['echo', 'hello'\], got str: 'echo hello'"),
        ({"cmd": ["true"], "respawn": 3}, TypeError, "value='3' is not an instance of <class 'bool'>"),
        ({"cmd": ["sleep", 5]}, TypeError, "Failed to normalize given item of type '<class 'int'>'"),
    ],
)
def test_process_arguments_of_the_wrong_type_are_refused_at_once(
    arguments: dict[str, Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        ExecuteProcess(**arguments)


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ("scren", 'scren is not a valid standard output config i.e. "screen", "log" or "both"'),
        ({"out": "screen"}, 'out is not a valid output source i.e. "stdout", "stderr" or "both"'),
        ({"stdout": "scren"}, "['scren'] is not a valid output destination i.e. "),
    ],
)
def test_an_invalid_output_setting_ends_the_launch(
    capsys: pytest.CaptureFixture[str], output: Any, message: str
) -> None:
    assert service_with(ExecuteProcess(cmd=["true"], output=output)).run() == 1
    assert message in capsys.readouterr().out


def test_an_event_handler_refuses_targets_and_handlers_of_other_types() -> None:
    with pytest.raises(TypeError, match="action_matcher must be an 'ExecuteLocal' instance or a callable, got LogInfo"):
        OnProcessExit(target_action=LogInfo(msg=""), on_exit=[])
    with pytest.raises(
        TypeError, match="expected all items in 'on_event' iterable to be of type 'LaunchDescriptionEnt"
    ):
        OnProcessExit(on_exit=["not an action"])
    with pytest.raises(TypeError, match="expected entities or a callable to handle an event with, got '<class 'int'>'"):
        OnShutdown(on_shutdown=5)


def test_opaque_functions_and_coroutines_refuse_values_of_other_types() -> None:
    with pytest.raises(TypeError, match="OpaqueFunction expected a callable for 'function', got '<class 'str'>'"):
        OpaqueFunction(function="f")
    with pytest.raises(TypeError, match="OpaqueCoroutine expected a coroutine function for 'coroutine'"):
        OpaqueCoroutine(coroutine=print)
