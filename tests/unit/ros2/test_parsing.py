"""The command line of `ros2`: its verbs, the commands that it does not cover, and its exit status."""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.ros2.exceptions import NotCoveredError
from autograder.ros.ros2.main import COMMANDS
from autograder.ros.ros2.main import run_stand_in as main
from autograder.ros.ros2.parsing import Verb, parse, positive_float, positive_int, unsigned_int

COVERED = {name: command for name, command in COMMANDS.items() if command.module}
VERBS = [
    (name, verb.name)
    for name, command in COVERED.items()
    if not isinstance(loaded := command.load(), Verb)
    for verb in loaded
]


@pytest.mark.parametrize("words", [(), *((name,) for name in COVERED), *VERBS], ids=" ".join)
def test_every_help_says_that_this_is_a_stand_in(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_info:
        parse(COMMANDS, [*words, "--help"])
    assert exit_info.value.code == 0
    printed = capsys.readouterr().out
    assert printed.startswith(" ".join(["usage: ros2", *words]))
    assert "This is a stand-in for ros2cli" in printed
    assert "make real-launch" in printed


@pytest.mark.parametrize("words", [(), ("topic",), ("pkg",)])
def test_a_command_alone_prints_its_help(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 0
    assert capsys.readouterr().out.startswith(" ".join(["usage: ros2", *words]))


@pytest.mark.parametrize(
    "words",
    [("bag", "record"), ("daemon", "stop"), ("component", "list"), ("topic", "delay", "/x"), ("service", "echo", "/x")],
)
def test_an_uncovered_command_is_named_with_the_installation_that_has_it(words: tuple[str, ...]) -> None:
    outcome = main(words)
    assert isinstance(outcome, str)
    command_name = " ".join(words if words[0] in COVERED else words[:1]).split(" /")[0]
    assert outcome.startswith(f"`ros2 {command_name}` is not covered by this stand-in")
    installation = f"install it with `make real-launch`, or source a ROS 2 {DISTRIBUTION.title}"
    assert f"works with the real ros2cli: {installation}" in outcome


@pytest.mark.parametrize("words", [("tpoic", "list"), ("topic", "lst"), ("topic", "echo"), ("topic", "pub", "-r", "0")])
def test_a_mistyped_argument_is_an_error_of_argparse(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as exit_info:
        main(words)
    assert exit_info.value.code == 2
    assert capsys.readouterr().err.startswith("usage: ros2")


def test_a_verb_gets_its_own_arguments() -> None:
    run, args = parse(COMMANDS, ["param", "set", "/robot", "speed", "-1.5"])
    assert (args.node_name, args.parameter_name, args.value) == ("/robot", "speed", "-1.5")
    assert run.__module__ == "autograder.ros.ros2.param"
    _, args = parse(COMMANDS, ["run", "pkg", "exe", "--ros-args", "-p", "a:=1"])
    assert args.argv == ["--ros-args", "-p", "a:=1"]
    _, args = parse(COMMANDS, ["topic", "pub", "-1", "/cmd_vel", "geometry_msgs/msg/Twist"])
    assert (args.once, args.values) == (True, "{}")
    for words in (["topic", "list", "--no-daemon", "--spin-time", "2"], ["node", "list", "--no-daemon"]):
        assert parse(COMMANDS, words)[1].no_daemon


def test_a_command_that_is_not_covered_raises_when_parsed() -> None:
    with pytest.raises(NotCoveredError, match="`ros2 bag`"):
        parse(COMMANDS, ["bag", "play"])


@pytest.mark.parametrize(
    ("kind", "good", "bad"),
    [
        (positive_int, {"3": 3}, ("0", "-1", "x", "1.5")),
        (unsigned_int, {"0": 0, "3": 3}, ("-1", "x")),
        (positive_float, {"0.5": 0.5}, ("0", "-1", "inf", "nan", "x")),
    ],
)
def test_numbers_are_checked(kind: type, good: dict[str, float], bad: tuple[str, ...]) -> None:
    assert {text: kind(text) for text in good} == good
    for text in bad:
        with pytest.raises(argparse.ArgumentTypeError, match=r"[Vv]alue must be|Expects a floating point number"):
            kind(text)


@pytest.mark.promise(
    "They are used only if the real packages are not importable.",
    "After `make real-launch`, or with a sourced ROS 2,",
)
def test_the_real_ros2cli_takes_over_if_it_is_installed(tmp_path: Path) -> None:
    package = tmp_path / "ros2cli"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "cli.py").write_text("def main(*, argv):\n    print('the real one', argv)\n    return 3\n")
    code = "import sys; sys.path.insert(0, sys.argv.pop(1)); from autograder.ros.ros2 import main; sys.exit(main())"
    command = [sys.executable, "-c", code, str(tmp_path), "topic", "list"]
    completed = subprocess.run(command, capture_output=True, text=True)
    assert (completed.returncode, completed.stdout) == (3, "the real one ['topic', 'list']\n")


def test_verbs_without_a_graph_do_not_import_rclpy() -> None:
    code = (
        "import sys; from autograder.ros.ros2.main import run_stand_in; run_stand_in(['pkg', 'prefix', 'rclpy']); "
        "run_stand_in(['interface', 'show', 'std_msgs/msg/String']); print('rclpy' in sys.modules)"
    )
    completed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert completed.stdout.endswith("\nFalse\n"), completed.stderr


def test_a_closed_output_pipe_gives_no_traceback() -> None:
    shell = f"{sys.executable} -m autograder.ros.ros2 interface list | head -1"
    completed = subprocess.run(["bash", "-c", shell], capture_output=True, text=True)
    assert (completed.stdout, completed.stderr) == ("Messages:\n", "")


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("topic", "echo", "bad topic"), "topic name 'bad topic' is invalid"),
        (("service", "call", "bad name", "std_srvs/srv/Empty"), "Invalid service name"),
        (("topic", "pub", "/x", "std_msgs/msg/Empty", "-n", "bad name"), "Invalid node name"),
        (("topic", "pub", "bad topic", "std_msgs/msg/Empty"), "Invalid topic name"),
    ],
)
def test_a_name_that_ros_does_not_allow_is_an_error_without_a_traceback(words: tuple[str, ...], error: str) -> None:
    outcome = main(words)
    assert isinstance(outcome, str)
    assert outcome.startswith(error)


@pytest.mark.parametrize("domain", ["300", "-1", "lab"])
def test_a_domain_that_dds_has_no_ports_for_is_an_error(domain: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", domain)
    assert main(["node", "list"]) == f"ROS_DOMAIN_ID is '{domain}', but must be a number from 0 to 232"
