"""Launch files as students write them: their processes, output and exit codes."""

from __future__ import annotations

import re
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Start = Callable[..., Any]
CLEANLY = r"\[INFO\] \[{0}-\d+\]: process has finished cleanly \[pid \d+\]"


def test_a_node_comes_up_with_its_parameters_and_ends_at_ctrl_c(start: Start) -> None:
    launch = start("single")
    launch.wait_for(r"\[beacon-1\] .*ready: /beacon on /beat label='42' rate=4.0 sim=False")
    assert launch.interrupt() == 0
    assert re.search(r"\[INFO\] \[launch\]: All log files can be found below /.*\n", launch.text)
    assert re.search(r"\[INFO\] \[beacon-1\]: process started with pid \[\d+\]", launch.text)
    assert "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)\n" in launch.text
    assert re.search(CLEANLY.format("beacon"), launch.text)
    # Without a terminal, which would send SIGINT to all processes, launch sends it.
    assert "[INFO] [beacon-1]: sending signal 'SIGINT' to process[beacon-1]" in launch.text


def test_arguments_and_defaults_reach_the_launch_file(start: Start) -> None:
    launch = start("arguments", "robot:=r2", "mode:=park")
    assert launch.finish() == 0
    assert "[INFO] [launch.user]: mode park on /r2/scan" in launch.text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), r"missing required argument 'robot' \(description: 'name of the robot'\), given: \[\]"),
        (
            ("robot:=r2", "mode:=fly"),
            r"\"mode\" provided value \"fly\" is not valid. Valid options are: \['drive', 'park'\]",
        ),
    ],
)
def test_a_missing_or_invalid_argument_is_an_error(start: Start, arguments: tuple[str, ...], message: str) -> None:
    launch = start("arguments", *arguments)
    assert launch.finish() == 1
    assert re.search(
        rf"\[ERROR\] \[launch\]: Caught exception in launch \(see debug for traceback\): .*{message}", launch.text
    )


@pytest.mark.parametrize(
    ("arguments", "present", "absent"),
    [
        ((), ["light: driver", "real hardware", "just one"], ["simulator", "a fleet"]),
        (("sim:=true", "robots:=2"), ["light: simulator", "a fleet"], ["driver", "real hardware", "just one"]),
    ],
)
def test_conditions_decide_which_processes_are_started(
    start: Start, arguments: tuple[str, ...], present: list[str], absent: list[str]
) -> None:
    launch = start("conditions", *arguments)
    for text in present:
        launch.wait_for(text)
    assert launch.interrupt() == 0
    assert not [text for text in absent if text in launch.text]


def test_a_condition_that_is_neither_true_nor_false_is_an_error(start: Start) -> None:
    launch = start("conditions", "sim:=maybe")
    assert launch.finish() == 1
    assert "invalid condition expression, expected one of [true, 1, false, 0] but got 'maybe'" in launch.text


def test_arguments_of_an_included_file_are_limited_to_their_group(start: Start) -> None:
    launch = start("include", "rate:=20.0")
    launch.wait_for("ready: /included on /beat label='42' rate=20.0")
    launch.wait_for("name is not set here")
    assert launch.interrupt() == 0


def test_two_robots_in_namespaces_get_their_parameters_and_remappings(start: Start) -> None:
    launch = start("two_robots")
    launch.wait_for("ready: /robot1/beacon on /robot1/pulse label='anyone' rate=5.0")
    launch.wait_for("ready: /robot2/beacon on /robot2/beat label='second' rate=5.0")
    launch.wait_for("ready: /robot3/beacon on /shared/beat label='anyone' rate=5.0")
    assert launch.interrupt() == 0
    assert len(re.findall(CLEANLY.format("beacon"), launch.text)) == 3


def test_event_handlers_run_their_actions_in_the_order_of_events(start: Start) -> None:
    launch = start("events")
    assert launch.finish() == 0
    messages = re.findall(r"\[launch.user\]: (.*)", launch.text)
    assert messages[:3] == ["first started", "second is up", "second exited with 0"]
    # The completion and the handlers of the exit do not wait for each other.
    assert sorted(messages[3:]) == ["complete", "it was sh-3", "the end: that is all"]
    assert messages.index("it was sh-3") < messages.index("the end: that is all")
    assert "[INFO] [launch]: process[sh-3] was required: shutting down launched system" in launch.text
    assert re.search(r"sending signal 'SIGINT' to process\[light-1\]", launch.text)


def test_a_process_that_dies_is_restarted_until_its_retries_are_used_up(start: Start, tmp_path: Path) -> None:
    launch = start("respawn", f"count:={tmp_path / 'count'}")
    assert launch.finish() == 0
    assert re.findall(r"\[crash-1\] (run \d)", launch.text) == ["run 1", "run 2", "run 3"]
    assert len(re.findall(r"process started with pid", launch.text)) == 3
    assert re.search(CLEANLY.format("crash"), launch.text)


def test_ctrl_c_does_not_wait_for_the_pause_before_a_respawn(start: Start) -> None:
    launch = start("respawn_forever")
    launch.wait_for("process has died")
    assert launch.interrupt() == 0
    assert len(re.findall("process started with pid", launch.text)) == 1


def test_a_crash_is_reported_with_command_and_exit_code_and_other_processes_continue(start: Start, fleet: Path) -> None:
    launch = start("crash")
    launch.wait_for(
        rf"\[ERROR\] \[crash-1\]: process has died \[pid \d+, exit code 3, cmd '{fleet}/lib/fleet/crash --ros-args "
        r"-r __node:=sensor'\]\."
    )
    assert "[crash-1] about to crash" in launch.text
    launch.wait_for("light:")
    assert launch.interrupt() == 0
    assert re.search(CLEANLY.format("light"), launch.text)


def test_the_end_of_a_required_node_ends_the_launch(start: Start) -> None:
    launch = start("required")
    assert launch.finish() == 0
    assert "[INFO] [launch]: process[crash-2] was required: shutting down launched system" in launch.text
    assert re.search(r"\[INFO\] \[light-1\]: sending signal 'SIGINT' to process\[light-1\]", launch.text)


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("missing_executable", "executable 'status_publisher' not found on the libexec directory '{fleet}/lib/fleet' "),
        ("missing_package", "\"package 'turtlesim' not found, searching: ['{fleet}', '"),
        ("broken", "of format [py]:\n - NameError: name 'config' is not defined"),
    ],
)
def test_a_missing_or_wrong_part_of_a_launch_file_ends_the_launch_with_an_error(
    start: Start, fleet: Path, file: str, message: str
) -> None:
    launch = start(file)
    assert launch.finish() == 1
    assert "[ERROR] [launch]: Caught exception in launch (see debug for traceback): " in launch.text
    assert message.format(fleet=fleet) in launch.text


def test_a_missing_command_is_named_and_the_other_processes_continue(start: Start) -> None:
    launch = start("missing_command")
    assert launch.finish() == 0
    assert (
        "[ERROR] [no-such-program-1]: exception occurred while executing process:\nFileNotFoundError: " in launch.text
    )
    assert "[launch.user]: continues" in launch.text


def test_a_process_that_ignores_sigint_gets_sigterm(start: Start) -> None:
    launch = start("stubborn")
    launch.wait_for(r"\[stubborn-1\] stubborn")
    assert launch.interrupt() == 0
    assert (
        "[ERROR] [stubborn-1]: process[stubborn-1] failed to terminate '0.3' seconds after receiving 'SIGINT', "
        "escalating to 'SIGTERM'\n[INFO] [stubborn-1]: sending signal 'SIGTERM' to process[stubborn-1]" in launch.text
    )
    assert "exit code -15" in launch.text
    assert "SIGKILL" not in launch.text


def test_a_process_that_ignores_sigterm_gets_sigkill(start: Start) -> None:
    launch = start("stubborn", "very:=very")
    launch.wait_for(r"\[stubborn-1\] stubborn")
    assert launch.interrupt() == 0
    assert "failed to terminate '0.5' seconds after receiving 'SIGTERM', escalating to 'SIGKILL'" in launch.text
    assert "exit code -9" in launch.text


def test_a_second_ctrl_c_is_ignored(start: Start) -> None:
    launch = start("stubborn", "sigterm_timeout:=1", "very:=very")
    launch.wait_for(r"\[stubborn-1\] stubborn")
    launch.send(signal.SIGINT)
    launch.wait_for(r"user interrupted with ctrl-c \(SIGINT\)\n")
    launch.send(signal.SIGINT)
    assert launch.finish() == 0
    assert "user interrupted with ctrl-c (SIGINT) again, ignoring..." in launch.text


@pytest.mark.parametrize(
    "number",
    [signal.SIGTERM, *(pytest.param(number, marks=pytest.mark.nightly) for number in (signal.SIGHUP, signal.SIGQUIT))],
)
def test_other_signals_also_end_the_launch_in_order(start: Start, number: signal.Signals) -> None:
    launch = start("opaque")
    launch.wait_for(r"\[light-1\] light:")
    launch.wait_for(r"\[light-2\] light:")
    launch.send(number)
    assert launch.finish() == 1
    assert f"[WARNING] [launch]: received {number.name}, terminating..." in launch.text
    assert len(re.findall(CLEANLY.format("light"), launch.text)) == 2


def test_timers_fire_in_time_and_can_be_cancelled(start: Start) -> None:
    launch = start("timers")
    assert launch.finish() == 0
    assert re.findall(r"\[launch.user\]: (.*)", launch.text) == ["first", "second", "third"]


def test_parameters_come_from_files_with_substitutions_arguments_and_for_all_nodes(start: Start) -> None:
    launch = start("parameters")
    launch.wait_for("ready: /a on /beat label='e3 of the harness' rate=9.0")
    launch.wait_for("ready: /b on /beat label='e3' rate=3.0")
    assert launch.interrupt() == 0


def test_output_goes_to_the_destination_that_the_launch_file_names(start: Start, tmp_path: Path) -> None:
    launch = start("output", "word:=hi")
    assert launch.finish() == 0
    lines = launch.text.splitlines()
    for name, texts in (
        ("to-screen-1", ["pipe to-screen", "error to-screen"]),
        ("to-log-2", ["error to-log"]),
        ("mixed-3", ["pipe mixed"]),
        ("in-terminal-4", ["tty in-terminal", "error in-terminal"]),
    ):
        assert sorted(line for line in lines if line.startswith(f"[{name}]")) == sorted(f"[{name}] {s}" for s in texts)
    assert {"<pipe formatted>", "<error formatted>", "[echo-6] hi! and hi"} <= set(lines)
    assert "[printenv-7] ONLY=" in launch.text
    assert {"[env-8] yes", "[pwd-9] /", "[printf-10] no line end"} <= set(lines)
    assert "process details: cmd='echo $COURSE_WORD and hi', cwd='None', custom_env?=True" in launch.text
    (log,) = (tmp_path / "log").glob("2*/launch.log")
    assert re.search(r"\d+\.\d{7} \[to-log-2\] pipe to-log", log.read_text())
    assert (log.parent / "mixed-3-stderr.log").read_text() == "[mixed-3] error mixed\n"
    assert (tmp_path / "log" / "latest").resolve() == log.parent


def test_a_prefix_goes_before_the_executables_that_its_filter_names(start: Start) -> None:
    launch = start("output", "--launch-prefix", "echo instead of", "--launch-prefix-filter", "print(env|f)")
    assert launch.finish() == 0
    assert "[echo-7] instead of printenv" in launch.text
    assert "[echo-10] instead of printf no line end" in launch.text
    assert "[pwd-9] /" in launch.text


def test_options_and_variables_override_where_output_goes(
    start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    all_lines = {"[to-log-2] pipe to-log", "[to-log-2] error to-log", "[mixed-3] pipe mixed", "[mixed-3] error mixed"}
    by_option = start("output", "word:=hi", "--show-all-subprocesses-output")
    assert by_option.finish() == 0
    assert all_lines <= set(by_option.text.splitlines())
    (log,) = (tmp_path / "log").glob("2*/launch.log")
    assert "[mixed-3] error mixed" in log.read_text()
    assert not (log.parent / "mixed-3-stderr.log").exists()
    monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "own_log")
    by_variable = start("output", "word:=hi")
    assert by_variable.finish() == 0
    assert not [line for line in by_variable.text.splitlines() if line.startswith("[to-screen-1]")]


def test_a_function_creates_as_many_processes_as_its_argument_says(start: Start) -> None:
    launch = start("opaque", "robots:=3")
    for index in range(3):
        launch.wait_for(rf"light: --ros-args -r __node:=robot{index} -r __ns:=/r{index}\n")
    assert launch.interrupt() == 0


def test_child_processes_end_with_their_parents(start: Start) -> None:
    launch = start("offspring")
    launch.wait_for(r"\[sh-2\]: process has finished cleanly")
    launch.wait_for("waiting")
    assert launch.interrupt() == 0
    assert "] not reached" not in launch.text
    assert launch.members() == {}
