"""Output of the verbs, and how they read files and numbers, without a node."""

from __future__ import annotations

from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.graph import NodeName, has_hidden_part, warn_of_duplicates
from autograder.ros.ros2.interface_text import expand_lines, nested_type
from autograder.ros.ros2.launch import find_launch_file, launch_arguments
from autograder.ros.ros2.message_values import make_message
from autograder.ros.ros2.param_client import nested, parameters_in_file
from autograder.ros.ros2.pkg_create import files
from autograder.ros.ros2.pkg_templates import PackageSpec, licence_text, setup_py
from autograder.ros.ros2.topic_echo import message_filter
from autograder.ros.ros2.topic_rate import Rate

INTERFACES = {
    "a_msgs/msg/Outer": "# About it.\n\nInner inner  # one\nb_msgs/Other[3] others\n"
    "uint8 KIND=1\nstring<=5 name 'a # b'\n",
    "a_msgs/msg/Inner": "# Hidden.\nfloat64 x # metres\n\nint32[<=4] ids\n",
    "b_msgs/msg/Other": "bool flag\n",
}


def test_nested_interfaces_unfold_below_their_field() -> None:
    assert list(expand_lines("a_msgs/msg/Outer", INTERFACES.__getitem__)) == [
        "# About it.",
        "",
        "Inner inner  # one",
        "\tfloat64 x",
        "\tint32[<=4] ids",
        "b_msgs/Other[3] others",
        "\tbool flag",
        "uint8 KIND=1",
        "string<=5 name 'a # b'",
    ]


def test_comments_can_be_kept_everywhere_or_nowhere() -> None:
    with_all_comments = list(expand_lines("a_msgs/msg/Outer", INTERFACES.__getitem__, nested_comments=True))
    assert "\t# Hidden." in with_all_comments
    assert "\tfloat64 x # metres" in with_all_comments
    without_comments = list(expand_lines("a_msgs/msg/Outer", INTERFACES.__getitem__, comments=False))
    assert without_comments[0] == "Inner inner"
    assert "string<=5 name 'a # b'" in without_comments


@pytest.mark.parametrize(
    ("line", "inner"),
    [
        ("std_msgs/Header header", "std_msgs/msg/Header"),
        ("geometry_msgs/msg/Point[] points", "geometry_msgs/msg/Point"),
        ("Point[<=3] points", "pkg/msg/Point"),
        ("float64 x 1.0", None),
        ("uint8 OK=0", None),
        ("---", None),
        ("# std_msgs/Header header", None),
        ("", None),
    ],
)
def test_a_field_names_the_message_in_it(line: str, inner: str | None) -> None:
    assert nested_type(line, "pkg") == inner


@pytest.mark.parametrize(
    ("text", "name"),
    [("talker", "/talker"), ("/talker", "/talker"), ("lab/helper", "/lab/helper"), ("/a/b/c", "/a/b/c")],
)
def test_a_node_has_one_full_name_however_it_is_typed(text: str, name: str) -> None:
    assert NodeName.parse(text).full_name == name


def test_hidden_names_begin_with_an_underscore() -> None:
    assert NodeName.parse("/_ros2cli_1").is_hidden
    assert [has_hidden_part(name) for name in ("/a/_action/status", "/a_b", "/_x")] == [True, False, True]


def test_two_nodes_with_the_same_name_cause_a_warning(capsys: pytest.CaptureFixture[str]) -> None:
    warn_of_duplicates([NodeName("a", "/"), NodeName("b", "/")])
    assert capsys.readouterr().err == ""
    warn_of_duplicates([NodeName("a", "/"), NodeName("a", "/")])
    assert capsys.readouterr().err.startswith("WARNING: Be aware that there are nodes in the graph that share")


def test_a_rate_is_computed_from_the_gaps() -> None:
    assert Rate.of([5]) is None
    assert str(Rate.of([0, 100_000_000, 300_000_000])) == (
        "average rate: 6.667\n\tmin: 0.100s max: 0.200s std dev: 0.05000s window: 2"
    )
    assert Rate.of([7, 7]) == Rate(0.0, 0.0, 0.0, 0.0, 1)


@settings(deadline=None)
@given(st.lists(st.integers(0, 10**12), min_size=2).map(sorted))
def test_the_mean_gap_is_between_the_shortest_and_the_longest(arrivals: list[int]) -> None:
    rate = Rate.of(arrivals)
    assert rate is not None
    if rate.rate:
        assert rate.shortest <= 1 / rate.rate * (1 + 1e-9)
        assert 1 / rate.rate <= rate.longest * (1 + 1e-9)


def test_a_filter_is_a_python_expression_over_m() -> None:
    accept = message_filter("m.linear.x > 0")
    fast = Twist()
    fast.linear.x = 1.0
    assert (accept(fast), accept(Twist()), message_filter(None)(Twist())) == (True, False, True)
    with pytest.raises(Ros2Error, match="Invalid filter expression 'm >'"):
        message_filter("m >")


def test_a_goal_refuses_automatic_stamps() -> None:
    with pytest.raises(Ros2Error, match="Failed to populate request: Value 'now'"):
        make_message(Twist, "{linear: now}", "request", allow_stamps=False)


PARAMETERS = """
/**:
  ros__parameters: {speed: 1.0, deep: {er: {x: 1}}}
/lab/helper:
  ros__parameters: {speed: 2.0, names: [a, b]}
broken: 5
"""


def test_a_parameter_file_gives_a_node_its_own_values_over_those_for_all(tmp_path: Path) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(PARAMETERS)
    parameters = parameters_in_file(path, "/lab/helper", True)
    assert parameters["speed"].value.double_value == 2.0
    assert parameters["deep.er.x"].value.integer_value == 1
    assert list(parameters["names"].value.string_array_value) == ["a", "b"]
    assert set(parameters_in_file(path, "/lab/helper", False)) == {"speed", "names"}
    assert set(parameters_in_file(path, "/other", True)) == {"speed", "deep.er.x"}


@pytest.mark.parametrize(
    ("text", "node", "error"),
    [
        (PARAMETERS, "/broken", "broken has no mapping named ros__parameters"),
        ("- 1", "/a", "it has no node names at its top level"),
        ("/b: {ros__parameters: {}}", "/a", "does not contain parameters for /a, only for nodes: /b"),
        ("a: [", "/a", "Cannot read the parameter file"),
    ],
)
def test_a_wrong_parameter_file_is_an_error(tmp_path: Path, text: str, node: str, error: str) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(text)
    with pytest.raises(Ros2Error, match=error):
        parameters_in_file(path, node, True)
    with pytest.raises(Ros2Error, match="Cannot read the parameter file"):
        parameters_in_file(tmp_path / "none.yaml", node, True)


def test_dotted_names_become_nested_mappings() -> None:
    assert nested({"a": 1, "b.c": 2, "b.d.e": 3}) == {"a": 1, "b": {"c": 2, "d": {"e": 3}}}


def test_launch_arguments_are_names_and_values() -> None:
    assert launch_arguments(["a:=1", "b:=x:=y", "a:=2"]) == {"a": "2", "b": "x:=y"}


@pytest.mark.parametrize("word", ["a=1", ":=1", "a:="])
def test_a_launch_argument_without_a_name_or_value_is_refused(word: str) -> None:
    with pytest.raises(Ros2Error, match=f"malformed launch argument '{word}', expected format '<name>:=<value>'"):
        launch_arguments([word])


def test_after_a_path_of_a_launch_file_all_words_are_arguments(tmp_path: Path) -> None:
    path = tmp_path / "x.launch.py"
    path.touch()
    assert find_launch_file(str(path), "a:=1", ["b:=2"]) == (path, ["a:=1", "b:=2"])


def spec(**fields: str) -> PackageSpec:
    return PackageSpec(
        name="p",
        build_type=fields.get("build_type", "ament_python"),
        package_format=3,
        description=fields.get("description", "d"),
        licence="MIT",
        maintainer_name="A",
        maintainer_email="a@example.com",
        node_name=fields.get("node_name"),
        library_name=fields.get("library_name"),
    )


@settings(deadline=None)
@given(st.text())
def test_any_description_is_kept_by_setup_py(description: str) -> None:
    line = next(
        line for line in setup_py(spec(description=description)).split("\n") if line.startswith("    description=")
    )
    assert eval(line.strip().removeprefix("description=").rstrip(",")) == description


def test_each_build_type_has_its_files() -> None:
    python = dict(files(spec(node_name="n", library_name="l"), "licence"))
    assert set(python) == {
        "package.xml", "LICENSE", "setup.py", "setup.cfg", "resource/p", "p/", "p/__init__.py", "p/n.py",
        "p/l/__init__.py", "test/test_copyright.py", "test/test_flake8.py", "test/test_pep257.py",
    }  # fmt: skip
    assert "tests_require=['pytest']" in python["setup.py"]
    assert "script_dir=$base/lib/p" in python["setup.cfg"]
    cmake = dict(files(spec(build_type="ament_cmake"), None))
    assert set(cmake) == {"package.xml", "CMakeLists.txt", "src/", "include/p/"}
    assert "LICENSE" not in cmake


def test_a_licence_text_names_the_holder() -> None:
    assert "Copyright (c) 2026 Ada" in (licence_text("BSD-3-Clause", "Ada", 2026) or "")
    assert licence_text("Mine", "Ada", 2026) is None
