"""Nodes: their command lines, and where they and their packages are found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from launch import LaunchContext
from launch.actions import GroupAction, OpaqueFunction, SetLaunchConfiguration
from launch.substitutions import LaunchConfiguration, SubstitutionFailure, TextSubstitution
from launch_ros.actions import (
    Node,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
)
from launch_ros.descriptions import Parameter
from launch_ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare

Run = Callable[..., int]


class Recorded(Node):
    """A node that records its command line and is not run."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(executable="/bin/node", **kwargs)
        self.words: list[str] = []
        self.files: list[Any] = []

    def execute(self, context: LaunchContext) -> None:
        arguments = [
            *self._name_arguments(context), *self._parameter_arguments(context), *self._remap_arguments(context)
        ]  # fmt: skip
        self.process_description.prepare(context, self)
        self.words = [*self.process_description.final_cmd, *arguments]
        for before, word in zip(self.words, self.words[1:], strict=False):
            if before == "--params-file":
                self.files.append(yaml.safe_load(Path(word).read_text()))


def test_a_node_gets_name_namespace_and_remappings(run: Run) -> None:
    node = Recorded(
        name="driver",
        namespace=["robot_", LaunchConfiguration("n", default="1")],
        remappings=[("scan", "front/scan"), (["c", "md"], TextSubstitution(text="/cmd_vel"))],
        arguments=["--fast"],
        ros_arguments=["--log-level", "debug"],
    )
    run(node)
    assert node.words == [
        "/bin/node", "--fast", "--ros-args", "--log-level", "debug", "--ros-args", "-r", "__node:=driver",
        "-r", "__ns:=/robot_1", "-r", "scan:=front/scan", "-r", "cmd:=/cmd_vel",
    ]  # fmt: skip
    assert node.node_name == "/robot_1/driver"
    assert node.expanded_remapping_rules == [("scan", "front/scan"), ("cmd", "/cmd_vel")]


def test_a_node_without_a_name_in_the_launch_file_keeps_its_own_name(run: Run) -> None:
    node = Recorded()
    run(node)
    assert node.words == ["/bin/node", "--ros-args"]
    assert not node.is_node_name_fully_specified()


def test_pushed_namespaces_and_remaps_apply_within_their_group(run: Run) -> None:
    first, second, third, outside = (Recorded(name="n") for _ in range(4))
    absolute = Recorded(name="n", namespace="/own")
    inner_group = GroupAction([PushRosNamespace("arm"), second])
    run(GroupAction([PushRosNamespace("robot1"), SetRemap("a", "b"), first, inner_group, third, absolute]), outside)
    names = [node.node_name for node in (first, second, third, absolute)]
    assert names == ["/robot1/n", "/robot1/arm/n", "/robot1/n", "/own/n"]
    assert first.words[-2:] == ["-r", "a:=b"]
    assert outside.words == ["/bin/node", "--ros-args", "-r", "__node:=n"]


def test_parameters_go_to_a_file_for_any_node_or_for_the_named_one(run: Run) -> None:
    plain = Recorded(name="n", parameters=[{"speed": 0.5, "deep": {"er": [1, 2]}}])
    named = Recorded(name="n", namespace="/ns", parameters=[{"speed": 1}])
    run(plain, named)
    assert plain.files == [{"/**": {"ros__parameters": {"speed": 0.5, "deep.er": [1, 2]}}}]
    assert named.files == [{"/ns/n": {"ros__parameters": {"speed": 1}}}]


def test_parameters_for_all_nodes_come_before_own_ones_and_end_with_their_group(run: Run, tmp_path: Path) -> None:
    (tmp_path / "all.yaml").write_text("/**: {ros__parameters: {a: 1}}")
    in_group, out_of_group = Recorded(parameters=[{"rate": 1}]), Recorded()
    run(
        GroupAction(
            [
                SetParameter("rate", 5),
                SetParameter(name="rate", value=7),
                SetParameter("text", "5"),
                SetParameter("list", [1.0, 2.0]),
                SetParametersFromFile([str(tmp_path), "/all.yaml"]),
                in_group,
            ]
        ),
        out_of_group,
    )
    assert in_group.words[2:-2] == [
        "-p", "rate:=7", "-p", "text:=5", "-p", "list:=[1.0, 2.0]",
        "--params-file", str(tmp_path / "all.yaml"),
    ]  # fmt: skip
    assert in_group.files[-1] == {"/**": {"ros__parameters": {"rate": 1}}}
    assert out_of_group.words == ["/bin/node", "--ros-args"]


def test_single_parameters_are_passed_for_the_named_node(run: Run) -> None:
    named, unnamed = Recorded(name="n", parameters=[Parameter("p", 1)]), Recorded(parameters=[Parameter("p", "x")])
    run(named, unnamed)
    assert named.words[-2:] == ["-p", "n:p:=1\n...\n"]
    assert unnamed.words[-2:] == ["-p", "p:=x\n...\n"]


def test_a_missing_parameter_file_causes_a_warning_and_is_ignored(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    node = Recorded(parameters=["/no/such.yaml"])
    run(node)
    assert node.words == ["/bin/node", "--ros-args"]
    assert (
        "[WARNING] [launch_ros.actions.node]: Parameter file path is not a file: /no/such.yaml"
        in capsys.readouterr().out
    )


def test_a_parameter_file_for_all_nodes_that_is_missing_is_an_error(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(SetParametersFromFile("/no/such.yaml")) == 1
    assert "SetParametersFromFile: there is no parameter file '/no/such.yaml'" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"name": "no-dashes"}, "Invalid node name"),
        ({"name": "n", "namespace": "a b"}, "Invalid namespace"),
    ],
)
def test_an_invalid_name_is_an_error(
    run: Run, capsys: pytest.CaptureFixture[str], arguments: dict[str, str], message: str
) -> None:
    assert run(Recorded(**arguments)) == 1
    out = capsys.readouterr().out
    assert "[ERROR] [launch_ros.actions.node]: Error while expanding or validating node name or namespace for" in out
    assert message in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"remappings": ["a:=b"]}, r"Node: remappings must be pairs such as \('scan', 'front/scan'\), got 'a:=b'"),
        ({"remappings": [("a", "b", "c")]}, "Node: remappings must be pairs"),
        ({"arguments": "--fast"}, "Node: arguments must be a list of strings, got the string '--fast'"),
        ({"ros_arguments": "-r"}, "Node: ros_arguments must be a list of strings, got the string '-r'"),
    ],
)
def test_arguments_of_the_wrong_shape_are_refused_at_once(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        Node(executable="node", **arguments)


def test_a_parameter_for_all_nodes_is_one_value() -> None:
    with pytest.raises(TypeError, match="SetParameter: the value must be a scalar or a list, got a dictionary"):
        SetParameter("p", {"a": 1})


def test_two_nodes_of_one_full_name_cause_a_warning(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    run(Node(executable="true", name="n", namespace="/"), Node(executable="true", name="n", namespace="/"))
    expected = "[WARNING] [/n]: there are now at least 2 nodes with the name /n created within this launch context"
    assert expected in capsys.readouterr().out


def test_packages_and_their_executables_are_found(
    context: LaunchContext, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    index = tmp_path / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    for package in ("with_lib", "without_lib"):
        (index / package).touch()
        (tmp_path / "share" / package).mkdir()
    executable = tmp_path / "lib/with_lib/go"
    executable.parent.mkdir(parents=True)
    executable.write_text("#!/bin/sh\n")
    executable.chmod(0o755)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert FindPackagePrefix("with_lib").perform(context) == str(tmp_path)
    assert FindPackageShare(["with", "_lib"]).perform(context) == str(tmp_path / "share/with_lib")
    assert ExecutableInPackage("go", "with_lib").perform(context) == str(executable)
    with pytest.raises(
        SubstitutionFailure, match=r"executable 'stop' not found on the libexec directory '.*/lib/with_lib'"
    ):
        ExecutableInPackage(executable="stop", package="with_lib").perform(context)
    with pytest.raises(
        SubstitutionFailure, match=r"package 'without_lib' found at .*, but libexec directory .*not exist"
    ):
        ExecutableInPackage("go", "without_lib").perform(context)
    with pytest.raises(LookupError, match=f"package 'nowhere' not found, searching: .*{tmp_path}"):
        FindPackageShare("nowhere").perform(context)


def test_configurations_for_nodes_do_not_disturb_those_of_the_user(run: Run) -> None:
    configurations: dict[str, Any] = {}

    def read_configurations(context: LaunchContext) -> None:
        configurations.update(context.launch_configurations)

    run(
        SetLaunchConfiguration("speed", "1"),
        GroupAction([SetParameter("a", 1)]),
        OpaqueFunction(function=read_configurations),
    )
    assert configurations == {"speed": "1"}
