"""Parameters, namespaces, remappings and packages: what a node's command line comes to."""

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
    SetUseSimTime,
)
from launch_ros.descriptions import Parameter, ParameterFile, ParameterValue
from launch_ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare
from launch_ros.utilities import evaluate_parameters, make_namespace_absolute, prefix_namespace

Run = Callable[..., int]
SPEED = LaunchConfiguration("speed")
ROBOT = LaunchConfiguration("robot")


@pytest.mark.parametrize(
    ("value", "evaluated"),
    [
        (5, 5),
        (0.5, 0.5),
        (True, True),
        ("text", "text"),
        ("5", "5"),
        ("yes", "yes"),
        (SPEED, 0.5),
        (LaunchConfiguration("sim"), True),
        (ROBOT, "r2"),
        ([ROBOT, "/scan"], "r2/scan"),
        (TextSubstitution(text="[1, 2]"), [1, 2]),
        ([1, 2, 3], [1, 2, 3]),
        ((1, 2.5), [1.0, 2.5]),
        (["a", "b"], ["a", "b"]),
        ([[ROBOT], [SPEED, "m"]], ["r2", "0.5m"]),
        ([1, "a"], ["1", "a"]),
        ([True, False], [True, False]),
        (ParameterValue(SPEED, value_type=str), "0.5"),
        (ParameterValue(SPEED, value_type=float), 0.5),
        (ParameterValue(TextSubstitution(text="3"), value_type=float), 3.0),
        (ParameterValue(TextSubstitution(text="[a, b]"), value_type=list[str]), ["a", "b"]),
        (ParameterValue(7), 7),
    ],
)
def test_a_parameter_keeps_its_type_and_a_substitution_gets_one(
    context: LaunchContext, value: Any, evaluated: Any
) -> None:
    (result,) = evaluate_parameters(context, [{"p": value}])
    assert result == {"p": evaluated}
    assert isinstance(result, dict)
    assert type(result["p"]) is type(evaluated)


def test_nested_parameters_become_dotted_names(context: LaunchContext) -> None:
    parameters = {"controller": {"gains": {"p": 1.0}, ("name_of_", ROBOT): "x"}, "rate": 10}
    (result,) = evaluate_parameters(context, [parameters])
    assert result == {"controller.gains.p": 1.0, "controller.name_of_r2": "x", "rate": 10}


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        (TextSubstitution(text="a: b: c"), ValueError, "Unable to parse the value of parameter p as yaml. If the para"),
        (TextSubstitution(text="{a: 1}"), TypeError, "parameter 'p': allowed values are bool, int.*which is dict"),
        (TextSubstitution(text="[1, a]"), TypeError, "parameter 'p': allowed values are bool, int.*which is list"),
        (None, TypeError, "parameter 'p': allowed values are bool, int, float, str.*got NoneType"),
        ({1, 2}, TypeError, "parameter 'p': allowed values are bool, int, float, str.*got set"),
        (
            [[SPEED], [ROBOT]],
            TypeError,
            r"parameter 'p': expected a list with items of uniform type, got \[0.5, 'r2'\]",
        ),
        (ParameterValue(ROBOT, value_type=int), ValueError, "invalid literal for int.*'r2'"),
        (ParameterValue(ROBOT, value_type=bool), ValueError, "Cannot convert value 'r2' to '<class 'bool'>'"),
        (
            ParameterValue(ROBOT, value_type=list[int]),
            ValueError,
            "Cannot convert value 'r2' to a list of '<class 'int'>'",
        ),
    ],
)
def test_a_value_that_no_parameter_can_have_is_refused(
    context: LaunchContext, value: Any, error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        evaluate_parameters(context, [{"p": value}])


def test_a_parameter_value_of_another_type_is_refused_at_once() -> None:
    with pytest.raises(TypeError, match="value='fast' is not an instance of <class 'float'>"):
        ParameterValue("fast", value_type=float)
    with pytest.raises(ValueError, match=r"data_type is invalid. Expected one of: int, float, str, bool, List"):
        ParameterValue(ROBOT, value_type=dict)


def test_files_come_as_paths_and_single_parameters_as_pairs(context: LaunchContext) -> None:
    given = [Path("/a.yaml"), "/b.yaml", ["/", ROBOT, ".yaml"], ParameterFile("/c.yaml"), Parameter("p", SPEED)]
    assert evaluate_parameters(context, given) == [
        Path("/a.yaml"), Path("/b.yaml"), Path("/r2.yaml"), Path("/c.yaml"), ("p", 0.5),
    ]  # fmt: skip


@pytest.mark.parametrize("given", ["/a.yaml", {"p": 1}, Path("/a.yaml")])
def test_parameters_must_be_a_list(context: LaunchContext, given: Any) -> None:
    with pytest.raises(TypeError, match=r"Expecting list of parameters, got .*: put it in a list, parameters="):
        evaluate_parameters(context, given)


def test_other_things_are_no_parameters(context: LaunchContext) -> None:
    with pytest.raises(TypeError, match=r"parameters must be files, dictionaries or launch_ros.descriptions, got int"):
        evaluate_parameters(context, [5])


def test_substitutions_in_a_parameter_file_are_performed_where_allowed(
    context: LaunchContext, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COURSE_SITE", "lab")
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n"
        "    # a comment with $(var nothing) in it\n"
        "    speed: $(var speed)\n    name: $(var robot)_$(env COURSE_SITE)\n"
        "    other: $(var missing fallback)\n    sum: $(eval '1 + 2')\n    nested: $(env $(var robot)_X none)\n"
    )
    evaluated = ParameterFile([str(tmp_path), "/p.yaml"], allow_substs=True).evaluate(context)
    assert evaluated != file
    assert yaml.safe_load(evaluated.read_text())["/**"]["ros__parameters"] == {
        "speed": 0.5, "name": "r2_lab", "other": "fallback", "sum": 3, "nested": "none",
    }  # fmt: skip
    assert ParameterFile(file).evaluate(context) == file


def test_a_value_that_looks_like_a_substitution_is_left_as_it_is(context: LaunchContext, tmp_path: Path) -> None:
    context.launch_configurations.update({"odd": "$(var odd) (so)", "name": "odd"})
    (tmp_path / "p.yaml").write_text("a: $(var $(var name)) $5 (five)")
    evaluated = ParameterFile(tmp_path / "p.yaml", allow_substs=True).evaluate(context)
    assert yaml.safe_load(evaluated.read_text()) == {"a": "$(var odd) (so) $5 (five)"}


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("a: $(var missing)", SubstitutionFailure, "launch configuration 'missing' does not exist"),
        ("a: '$(var robot'", SubstitutionFailure, r"has no end or cannot be read: \$\(var robot"),
        ("a: $(find-pkg-share a b)", SubstitutionFailure, r"\$\(find-pkg-share a b\): .*positional argument"),
        ("a: $(anon x)", ImportError, r"'\$\(anon ...\)' is not covered: this is the course's stand-in for launch_ros"),
        ("a: [", SubstitutionFailure, "The parameter file '.*' is not a valid yaml file, before applying"),
        ("a: $(var odd)", SubstitutionFailure, "The substituted parameter file '.*' is not a valid yaml file"),
    ],
)
def test_a_substitution_that_fails_in_a_parameter_file_says_why(
    context: LaunchContext, tmp_path: Path, text: str, error: type[Exception], message: str
) -> None:
    context.launch_configurations["odd"] = "x: y: z"
    (tmp_path / "p.yaml").write_text(text)
    with pytest.raises(error, match=message):
        ParameterFile(tmp_path / "p.yaml", allow_substs=True).evaluate(context)


@pytest.mark.parametrize(
    ("base", "namespace", "combined"),
    [
        (None, None, None),
        (None, "a", "a"),
        ("/a", None, "/a"),
        ("/a", "b", "/a/b"),
        ("/a/", "b/", "/a/b"),
        ("/a", "/b", "/b"),
        ("/a", "", "/a"),
        ("/", "b", "/b"),
        ("/a", "/", "/"),
    ],
)
def test_a_relative_namespace_goes_below_the_one_before(base: Any, namespace: Any, combined: Any) -> None:
    assert prefix_namespace(base, namespace) == combined


def test_a_namespace_is_made_absolute() -> None:
    assert [make_namespace_absolute(ns) for ns in ("a", "/a", None)] == ["/a", "/a", None]


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
        "/bin/node", "--fast", "--ros-args", "--log-level", "debug", "-r", "__node:=driver", "-r", "__ns:=/robot_1",
        "-r", "scan:=front/scan", "-r", "cmd:=/cmd_vel",
    ]  # fmt: skip
    assert node.node_name == "/robot_1/driver"


def test_a_node_without_a_name_keeps_its_own(run: Run) -> None:
    node = Recorded()
    run(node)
    assert node.words == ["/bin/node", "--ros-args"]
    assert not node.is_node_name_fully_specified()


def test_pushed_namespaces_and_remaps_hold_within_their_group(run: Run) -> None:
    first, second, third, outside = (Recorded(name="n") for _ in range(4))
    absolute = Recorded(name="n", namespace="/own")
    deeper = GroupAction([PushRosNamespace("arm"), second])
    run(GroupAction([PushRosNamespace("robot1"), SetRemap("a", "b"), first, deeper, third, absolute]), outside)
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
    inside, outside = Recorded(parameters=[{"rate": 1}]), Recorded()
    run(
        GroupAction(
            [
                SetParameter("rate", 5),
                SetParameter(name="rate", value=7),
                SetParameter("text", "5"),
                SetParameter("list", [1.0, 2.0]),
                SetUseSimTime(True),
                SetParametersFromFile([str(tmp_path), "/all.yaml"]),
                inside,
            ]
        ),
        outside,
    )
    assert inside.words[2:-2] == [
        "-p", "rate:=7", "-p", "text:='5'", "-p", "list:=[1.0, 2.0]", "-p", "use_sim_time:=true",
        "--params-file", str(tmp_path / "all.yaml"),
    ]  # fmt: skip
    assert inside.files[-1] == {"/**": {"ros__parameters": {"rate": 1}}}
    assert outside.words == ["/bin/node", "--ros-args"]


def test_single_parameters_are_passed_for_the_named_node(run: Run) -> None:
    named, unnamed = Recorded(name="n", parameters=[Parameter("p", 1)]), Recorded(parameters=[Parameter("p", "x")])
    run(named, unnamed)
    assert named.words[-2:] == ["-p", "n:p:=1"]
    assert unnamed.words[-2:] == ["-p", "p:='x'"]


def test_a_parameter_file_that_is_missing_is_warned_of_and_left_out(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    node = Recorded(parameters=["/no/such.yaml"])
    run(node)
    assert node.words == ["/bin/node", "--ros-args"]
    assert "[WARNING] [launch_ros]: Parameter file path is not a file: /no/such.yaml" in capsys.readouterr().out


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
    assert "[ERROR] [launch_ros]: Error while expanding or validating node name or namespace for 'package=None" in out
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


def test_two_nodes_of_one_full_name_are_warned_of(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
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
    seen: dict[str, Any] = {}

    def look(context: LaunchContext) -> None:
        seen.update(context.launch_configurations)

    run(SetLaunchConfiguration("speed", "1"), GroupAction([SetParameter("a", 1)]), OpaqueFunction(function=look))
    assert seen == {"speed": "1"}
