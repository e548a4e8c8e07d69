"""The output of `ros2 launch` is read for the checks. These tests do not run it."""

from __future__ import annotations

import pytest

from autograder.exceptions import StudentError
from autograder.harness.launch import Stop
from autograder.probes import launch_probe
from autograder.probes.launch_arguments import Argument, parse_arguments
from autograder.suite import CheckFailed

SHOWN = """Arguments (pass arguments as '<name>:=<value>'):

    'robot_name':
        who reports
        (default: 'robot1')

    'mode':
        What to do. Valid choices are: ['drive', 'park']
        (default: 'drive')

    'rest':
        no description given

    'topic':
        One of: ['a']
        (default: '/' + LaunchConfig('robot') + '/scan')
"""
STARTED = """[INFO] [launch]: All log files can be found below /tmp/log
[INFO] [self_test-1]: process started with pid [8]
[INFO] [reporter-2]: process started with pid [9]
[INFO] [self_test-1]: process has finished cleanly [pid 8]
[INFO] [driver-3]: process started with pid [12]
[driver-3] Traceback (most recent call last):
[driver-3]   File "driver.py", line 7, in main
[driver-3] rclpy.exceptions.InvalidParameterTypeException: Trying to set parameter 'speed' to '1' of type 'INTEGER'
[ERROR] [driver-3]: process has died [pid 12, exit code 1, cmd '/w/lib/p/driver --ros-args'].
"""
CAUGHT = "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "


def test_shown_arguments_are_read_with_description_default_and_choices() -> None:
    assert parse_arguments(SHOWN) == {
        "robot_name": Argument("robot_name", "who reports", "robot1", ()),
        "mode": Argument("mode", "What to do.", "drive", ("drive", "park")),
        "rest": Argument("rest", "", None, ()),
        "topic": Argument("topic", "", None, ("a",), is_computed=True),
    }


NOT_READ = """Traceback (most recent call last):
  File "/opt/launch/launch_description_sources.py", line 36, in load
    exec(code)
  File "/tmp/cell/ws/install/pkg/share/pkg/launch/robot.launch.py", line 28
    def generate_launch_description()
                                     ^
SyntaxError: expected ':'

launch.exceptions.InvalidLaunchFileError: Caught multiple exceptions when trying to load file of format [py]:
 - SyntaxError: expected ':' (robot.launch.py, line 28)
 - InvalidFrontendLaunchFileError: The launch file may have a syntax error, or its format is unknown
"""


def test_a_launch_file_that_cannot_be_read_is_reported_with_error_and_line() -> None:
    assert launch_probe.unreadable(NOT_READ) == "SyntaxError: expected ':' (robot.launch.py, line 28)"
    log = NOT_READ.replace("expected ':' (robot.launch.py, line 28)", "no such thing")
    assert launch_probe.unreadable(log) == "SyntaxError: no such thing (ws/src/pkg/launch/robot.launch.py, line 28)"
    assert launch_probe.unreadable("Package 'pkg' not found\n") == "Package 'pkg' not found"
    assert launch_probe.unreadable("") == "it printed nothing"


def test_choices_may_be_a_tuple() -> None:
    output = SHOWN.replace("['drive', 'park']", "('drive', 'park')")
    assert parse_arguments(output) == parse_arguments(SHOWN)


def test_a_launch_file_without_arguments_shows_none() -> None:
    assert parse_arguments("Arguments (pass arguments as '<name>:=<value>'):\n\n  No arguments.\n") == {}


@pytest.mark.parametrize(
    ("name", "default", "sentence"),
    [
        ("speed", "0.2", "The launch file declares no argument speed; it declares: robot_name, mode, rest, topic."),
        ("robot_name", "bob", "The argument robot_name has the default 'robot1', instead of 'bob'."),
        ("rest", "x", "The argument rest has no default, instead of 'x'."),
    ],
)
def test_a_wrong_argument_is_named(name: str, default: str, sentence: str) -> None:
    with pytest.raises(CheckFailed) as excinfo:
        launch_probe.expect_argument(parse_arguments(SHOWN), name, default)
    assert excinfo.value.message == sentence


@pytest.mark.parametrize("output", ["'rob' + 'ot1'", "'robot' + LaunchConfig('number')", "'' + 'robot1'"])
def test_a_default_of_several_substitutions_in_a_row_is_a_default(output: str) -> None:
    arguments = parse_arguments(SHOWN.replace("'robot1'", output))
    launch_probe.expect_argument(arguments, "robot_name", "robot1")


def test_a_default_of_several_texts_in_a_row_is_compared_as_one() -> None:
    arguments = parse_arguments(SHOWN.replace("'robot1'", "'rob' + 'ot2'"))
    with pytest.raises(CheckFailed, match="has the default 'robot2', instead of 'robot1'"):
        launch_probe.expect_argument(arguments, "robot_name", "robot1")


def test_an_argument_without_a_description_earns_half_the_points() -> None:
    with pytest.raises(CheckFailed, match="has no description") as excinfo:
        launch_probe.expect_argument({"speed": Argument("speed", "", "0.2", ())}, "speed", "0.2")
    assert excinfo.value.fraction == 0.5


def test_started_and_ended_programs_are_listed_in_order() -> None:
    assert launch_probe.started(STARTED) == ["self_test", "reporter", "driver"]
    assert launch_probe.ended(STARTED) == ["self_test", "driver"]


def test_node_names_are_read_from_the_commands_of_ended_processes() -> None:
    message = "[ERROR] [{}-{}]: process has died [pid 7, exit code -9, cmd 'lib/{} --ros-args -r __node:={}']."
    output = "\n".join(
        (message.format("self_test", 1, "self_test", "check"), message.format("driver", 2, "driver", "wheel"))
    )
    assert launch_probe.node_names(output, "self_test") == {"check"}
    assert launch_probe.node_names(STARTED, "self_test") == set()


def test_the_failure_names_the_process_that_died_and_the_cause() -> None:
    assert launch_probe.failure(STARTED) == (
        "driver died with exit code 1 (rclpy.exceptions.InvalidParameterTypeException: "
        "Trying to set parameter 'speed' to '1' of type 'INTEGER')"
    )


@pytest.mark.parametrize(
    ("output", "cause"),
    [
        (CAUGHT + "executable 'a' not found on the libexec directory '/w' \n", "executable 'a' not found on the"),
        (
            CAUGHT + "Caught exception when trying to load file of format [py]:\n - NameError: x\n",
            "[py]: - NameError: x",
        ),
        ("file 'x.launch.py' was not found, error\n", "file 'x.launch.py' was not found, error"),
        (
            CAUGHT + "cannot read /tmp/worker-x/job/ws-bad/install/lab/share/lab/config/lab.yaml\n",
            "cannot read ws/install/lab/share/lab/config/lab.yaml",
        ),
        ("[INFO] [launch]: Default logging verbosity is set to INFO\n", ""),
        ("", ""),
    ],
)
def test_the_failure_is_the_error_that_ended_the_launch(output: str, cause: str) -> None:
    failure = launch_probe.failure(output)
    assert cause in failure
    assert bool(failure) is bool(cause)


def test_an_unwritten_part_is_reported_as_unwritten() -> None:
    with pytest.raises(StudentError) as excinfo:
        launch_probe.require_written(f"{CAUGHT}\n - NotImplementedError: still to be written\n")
    assert excinfo.value.diagnosis.kind.value == "unfinished"
    assert "still to be written" in excinfo.value.diagnosis.sentence


@pytest.mark.parametrize(
    ("stop", "sentence"),
    [
        (Stop(None, ()), "It was still running after 20 s and had to be killed."),
        (Stop(0, ("sleep 600",)), "It ended, but left a process running: sleep 600."),
        (Stop(1, ()), "It ended with exit status 1, instead of 0."),
    ],
)
def test_a_stop_that_is_not_clean_is_described(stop: Stop, sentence: str) -> None:
    with pytest.raises(CheckFailed) as excinfo:
        launch_probe.expect_stopped(stop)
    assert excinfo.value.message == sentence


def test_a_clean_stop_passes() -> None:
    launch_probe.expect_stopped(Stop(0, ()))
