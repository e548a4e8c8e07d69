"""Substitutions: their values, when they are evaluated, and how they fail."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from launch import LaunchContext
from launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PathSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

ROBOT = LaunchConfiguration("robot")


@pytest.mark.parametrize(
    ("substitution", "text"),
    [
        (TextSubstitution(text="plain"), "plain"),
        (ROBOT, "r2"),
        (LaunchConfiguration(["ro", TextSubstitution(text="bot")]), "r2"),
        (LaunchConfiguration("missing", default="d"), "d"),
        (LaunchConfiguration("missing", default=5), "5"),
        (LaunchConfiguration("missing", default=["is ", ROBOT]), "is r2"),
        (EnvironmentVariable("NO_SUCH_VARIABLE", default_value="none"), "none"),
        (PathJoinSubstitution(["/opt", ROBOT, "map.yaml"]), "/opt/r2/map.yaml"),
        (PathJoinSubstitution(["/opt", ["map_", ROBOT, ".yaml"]]), "/opt/map_r2.yaml"),
        (PathSubstitution("/opt") / "maps" / ["map_", ROBOT, ".yaml"], "/opt/maps/map_r2.yaml"),
        (PathSubstitution(ROBOT) / (PathJoinSubstitution(["a", "b"]) / "c"), "r2/a/b/c"),
        (PythonExpression(["'", ROBOT, "' == 'r2' and 1 + 1"]), "2"),
        (PythonExpression(["floor(pi) + math.floor(", LaunchConfiguration("speed"), ")"]), "3"),
        (PythonExpression(["os.path.basename('/a/b')"], ["os"]), "b"),
        (Command(["echo ", ROBOT, " 'two words'"]), "r2 two words\n"),
        (Command("sh -c 'echo out; echo err >&2'", on_stderr="ignore"), "out\n"),
        (Command("sh -c 'echo err >&2'", on_stderr="capture"), "err\n"),
        (NotSubstitution(LaunchConfiguration("sim")), "false"),
        (NotSubstitution("off"), "true"),
        (AndSubstitution("true", LaunchConfiguration("sim")), "true"),
        (AndSubstitution("true", "no"), "false"),
        (OrSubstitution("false", "yes"), "true"),
        (AnySubstitution("false", "false", "true"), "true"),
        (AllSubstitution("true", "true", "false"), "false"),
        (EqualsSubstitution(ROBOT, "r2"), "true"),
        (EqualsSubstitution("1", True), "true"),
        (EqualsSubstitution(LaunchConfiguration("speed"), 0.50), "true"),
        (EqualsSubstitution(None, ""), "true"),
        (NotEqualsSubstitution([ROBOT, "d2"], "r2d2"), "false"),
        (NotEqualsSubstitution("a", "b"), "true"),
        (IfElseSubstitution(LaunchConfiguration("sim"), "simulated", "real"), "simulated"),
        (IfElseSubstitution("false", LaunchConfiguration("missing"), "real"), "real"),
    ],
)
def test_a_substitution_evaluates_to_its_text(context: LaunchContext, substitution: Any, text: str) -> None:
    assert context.perform_substitution(substitution) == text


@pytest.mark.parametrize(
    ("substitution", "message"),
    [
        (LaunchConfiguration("missing"), "launch configuration 'missing' does not exist"),
        (EnvironmentVariable("NO_SUCH_VARIABLE"), "environment variable 'NO_SUCH_VARIABLE' does not exist"),
        (FindExecutable(name="no-such-program"), "executable 'no-such-program' not found on the PATH"),
        (Command("no-such-program"), "file not found: .*'no-such-program'"),
        (Command("sh -c 'echo why >&2; exit 1'"), "executed command failed. Command: sh .*\n.*stderr output: why"),
        (Command("sh -c 'echo why >&2'"), "executed command showed stderr output. Command: sh .*\n.*:\nwhy"),
        (Command("true", on_stderr="shout"), "expected 'on_stderr' to be one of: 'fail', 'ignore', 'warn'"),
        (ThisLaunchFileDir(), r"ThisLaunchFileDir used outside of a launch file \(in a script\)"),
        (ThisLaunchFile(), r"ThisLaunchFile used outside of a launch file \(in a script\)"),
        (NotSubstitution("maybe"), "Cannot convert value 'maybe' to '<class 'bool'>'"),
        (LocalSubstitution("event.pid"), "local expression 'event.pid' cannot be resolved: .*'event'"),
        (LocalSubstitution("event pid"), "local expression 'event pid' cannot be resolved|is not a path"),
        (FileContent("/no/such/file"), "Failed to open file '/no/such/file': No such file or directory"),
    ],
)
def test_a_failed_substitution_gives_the_reason(context: LaunchContext, substitution: Any, message: str) -> None:
    with pytest.raises(SubstitutionFailure, match=message):
        context.perform_substitution(substitution)


def test_an_environment_variable_is_read_from_the_process_when_it_is_evaluated(
    context: LaunchContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    substitution = EnvironmentVariable("SET_LATER")
    monkeypatch.setenv("SET_LATER", "now")
    assert context.perform_substitution(substitution) == "now"


def test_a_local_value_is_found_by_attributes_and_keys(context: LaunchContext) -> None:
    context.extend_locals({"args": {"name": ["__node:=a", "__ns:=/b"]}})
    assert context.perform_substitution(LocalSubstitution("args['name'][1]")) == "__ns:=/b"


def test_an_executable_is_found_on_the_path(context: LaunchContext) -> None:
    executable = Path(context.perform_substitution(FindExecutable(name="sh")))
    assert executable.name == "sh"
    assert os.access(executable, os.X_OK)


def test_an_anonymous_name_stays_the_same_within_a_launch(context: LaunchContext) -> None:
    first = context.perform_substitution(AnonName("rviz"))
    assert first.startswith("rviz_")
    assert context.perform_substitution(AnonName("rviz")) == first
    assert LaunchContext().perform_substitution(AnonName("rviz")) != first


def test_the_log_folder_is_below_ros_log_dir(context: LaunchContext) -> None:
    folder = Path(context.perform_substitution(LaunchLogDir()))
    assert folder.is_dir()
    assert folder.parent == Path(os.environ["ROS_LOG_DIR"])


def test_file_content_is_the_text(context: LaunchContext, tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text("<robot/>")
    assert context.perform_substitution(FileContent([str(tmp_path), "/robot.urdf"])) == "<robot/>"


def test_strings_and_substitutions_in_a_row_are_joined(context: LaunchContext) -> None:
    parts = normalize_to_list_of_substitutions(["/", ROBOT, "/scan"])
    assert perform_substitutions(context, parts) == "/r2/scan"


@pytest.mark.parametrize("value", [5, True, [1, "a"], [None]])
def test_other_values_are_refused_as_substitutions(value: Any) -> None:
    with pytest.raises(
        TypeError, match=r"Failed to normalize given item of type .*'launch.Substitution' were expected"
    ):
        normalize_to_list_of_substitutions(value)


def test_text_must_be_text() -> None:
    with pytest.raises(TypeError, match="TextSubstitution expected Text object got '<class 'int'>' instead"):
        TextSubstitution(text=5)


def test_a_choice_needs_a_value() -> None:
    with pytest.raises(RuntimeError, match="One of if_value and else_value must be specified"):
        IfElseSubstitution("true")


@pytest.mark.parametrize(
    ("substitution", "description"),
    [
        (TextSubstitution(text="a"), "'a'"),
        (ROBOT, "LaunchConfig('robot')"),
        (EnvironmentVariable("HOME"), "EnvVar('HOME')"),
        (PythonExpression(["1 + ", ROBOT]), "PythonExpr('1 + ' + LaunchConfig('robot'), ['math'])"),
        (PathJoinSubstitution(["a", ROBOT]), "PathJoin('a', LaunchConfig('robot'))"),
        (FindExecutable(name="sh"), "FindExec('sh')"),
        (Command("ls"), "Command('ls')"),
        (LocalSubstitution("event.pid"), "LocalVar('event.pid')"),
        (ThisLaunchFileDir(), "ThisLaunchFileDir()"),
        (LaunchLogDir(), "LaunchLogDir()"),
        (AnonName("a"), "AnonName('a')"),
        (FileContent("a"), "FileContent('a')"),
        (NotSubstitution("true"), "NotSubstitution('true')"),
        (AndSubstitution("true", ROBOT), "AndSubstitution('true' LaunchConfig('robot'))"),
        (EqualsSubstitution("a", 1), "EqualsSubstitution('a' '1')"),
        (IfElseSubstitution("true", "a"), "IfElseSubstitution('true', 'a', '')"),
    ],
)
def test_a_substitution_describes_itself_without_a_context(substitution: Any, description: str) -> None:
    assert substitution.describe() == description


@pytest.mark.parametrize("kind", [AndSubstitution, OrSubstitution])
def test_both_operands_of_a_substitution_can_be_read(context: LaunchContext, kind: Any) -> None:
    condition = kind("true", ["f", LaunchConfiguration("rest", default="alse")])
    assert [context.perform_substitution(part) for part in condition.left] == ["true"]
    assert [context.perform_substitution(part) for part in condition.right] == ["f", "alse"]
