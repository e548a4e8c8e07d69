"""Errors of known races in rclpy are distinguished from errors of the program."""

from __future__ import annotations

import pytest

from autograder.probes.rclpy_races import crashed, lost_a_race

FRAMES = """[INFO] [1700000000.0] [robot_controller]: Blocked
Traceback (most recent call last):
  File "/w/lib/my_robot_package/robot_controller", line 8, in <module>
    sys.exit(main())
  File "/w/my_robot_package/robot_controller.py", line 16, in main
    rclpy.{call}()
"""
UTILITIES = """  File "/v/site-packages/rclpy/utilities.py", line 100, in try_shutdown
    g_default_context.try_shutdown()
"""
IN_TRY_SHUTDOWN = """  File "/v/site-packages/rclpy/context.py", line 139, in try_shutdown
    self.__context.shutdown()
"""
IN_SHUTDOWN = """  File "/v/site-packages/rclpy/context.py", line 129, in shutdown
    self.__context.shutdown()
"""
IN_WAIT_SET = """  File "/v/site-packages/rclpy/executors.py", line 640, in _wait_for_ready_callbacks
    wait_set = _rclpy.WaitSet(
"""
CALLED = "rclpy._rclpy_pybind11.RCLError: failed to shutdown: rcl_shutdown already called on the given context, at x\n"
NOT_VALID = "rclpy._rclpy_pybind11.RCLError: failed to initialize wait set: the given context is not valid, at x\n"
OWN = "ValueError: no context for this speed\n"


@pytest.mark.parametrize(
    "output",
    [
        FRAMES.format(call="try_shutdown") + UTILITIES + IN_TRY_SHUTDOWN + CALLED,
        FRAMES.format(call="try_shutdown") + UTILITIES + IN_TRY_SHUTDOWN + CALLED + "\n",
        FRAMES.format(call="spin") + IN_WAIT_SET + NOT_VALID,
    ],
    ids=["try_shutdown", "empty last line", "executor"],
)
def test_a_known_race_in_rclpy_is_recognized_as_such(output: str) -> None:
    assert lost_a_race(output)


@pytest.mark.parametrize(
    "output",
    [
        "",
        "\n",
        "[INFO] [1700000000.0] [robot_controller]: Blocked\n",
        FRAMES.format(call="shutdown") + IN_SHUTDOWN + CALLED,
        FRAMES.format(call="try_shutdown") + UTILITIES + IN_TRY_SHUTDOWN + OWN,
        FRAMES.format(call="spin") + OWN,
    ],
    ids=["nothing", "empty line", "log", "shutdown", "another error", "of the program"],
)
def test_an_error_of_the_program_is_not_recognized_as_a_race(output: str) -> None:
    assert not lost_a_race(output)


@pytest.mark.parametrize("status", [139, 134, -11, -6])
def test_a_crash_of_native_code_is_recognized_by_its_exit_status(status: int) -> None:
    assert crashed(status)


@pytest.mark.parametrize("status", [None, 0, 1, 2, 130, 143, -2, -9, -15, 137])
def test_no_other_exit_counts_as_a_crash(status: int | None) -> None:
    assert not crashed(status)
