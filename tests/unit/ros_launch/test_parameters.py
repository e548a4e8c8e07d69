"""Evaluation of parameters and namespaces."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from launch import LaunchContext
from launch.substitutions import LaunchConfiguration, SubstitutionFailure, TextSubstitution
from launch_ros.descriptions import Parameter, ParameterFile, ParameterValue
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


def test_other_values_are_refused_as_parameters(context: LaunchContext) -> None:
    with pytest.raises(TypeError, match=r"parameters must be files, dictionaries or launch_ros.descriptions, got int"):
        evaluate_parameters(context, [5])


def test_substitutions_in_a_parameter_file_are_performed_where_allowed(
    context: LaunchContext, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COURSE_SITE", "lab")
    file = tmp_path / "p.yaml"
    file.write_text(
        "/**:\n  ros__parameters:\n"
        "    speed: $(var speed)\n    name: $(var robot)_$(env COURSE_SITE)\n"
        "    other: $(var missing fallback)\n    sum: $(eval '1 + 2')\n    nested: $(env $(var robot)_X none)\n"
    )
    evaluated = ParameterFile([str(tmp_path), "/p.yaml"], allow_substs=True).evaluate(context)
    assert evaluated != file
    assert yaml.safe_load(evaluated.read_text())["/**"]["ros__parameters"] == {
        "speed": 0.5, "name": "r2_lab", "other": "fallback", "sum": 3, "nested": "none",
    }  # fmt: skip
    assert ParameterFile(file).evaluate(context) == file


def test_a_value_that_looks_like_a_substitution_is_unchanged(context: LaunchContext, tmp_path: Path) -> None:
    context.launch_configurations.update({"odd": "$(var odd) (so)", "name": "odd"})
    (tmp_path / "p.yaml").write_text("a: $(var $(var name)) $5 (five)")
    evaluated = ParameterFile(tmp_path / "p.yaml", allow_substs=True).evaluate(context)
    assert yaml.safe_load(evaluated.read_text()) == {"a": "$(var odd) (so) $5 (five)"}


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("a: $(var missing)", SubstitutionFailure, "launch configuration 'missing' does not exist"),
        ("a: '$(var robot'", ValueError, r"has no end or cannot be read: \$\(var robot"),
        ("a: $(find-pkg-share a b)", TypeError, "find-pkg-share substitution expects 1 argument"),
        ("a: $(nothing x)", RuntimeError, "Unknown substitution: nothing"),
        ("a: [", SubstitutionFailure, "The substituted parameter file '.*' is not a valid yaml file"),
        ("a: $(var odd)", SubstitutionFailure, "The substituted parameter file '.*' is not a valid yaml file"),
    ],
)
def test_a_failed_substitution_in_a_parameter_file_gives_the_reason(
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
