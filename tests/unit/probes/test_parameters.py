"""Sentences about a node's parameters and about parameter files."""

from __future__ import annotations

import contextlib
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.probes.parameters import (
    MAX_FILE,
    MAX_QUOTE,
    Value,
    as_declared,
    differences,
    for_node,
    missing_sentence,
    near_misses,
    override_arguments,
    read_file,
    same,
    shortened,
)
from autograder.suite import CheckFailed

EXPECTED = ("safety_distance", "slow_distance")


def test_a_missing_parameter_is_reported_with_the_one_of_a_similar_name() -> None:
    assert near_misses(EXPECTED, {"saftey_distance", "slow_distance"}) == {"safety_distance": "saftey_distance"}
    sentence = missing_sentence(EXPECTED, {"saftey_distance"})
    assert sentence == "The node does not declare safety_distance (it declares saftey_distance), slow_distance."


def test_only_some_of_many_long_names_are_compared() -> None:
    names = {*(f"safety_distance{number:06}" for number in range(300_000)), "slow_distance" * 100_000}
    assert near_misses(EXPECTED, names) == {"safety_distance": "safety_distance000000", "slow_distance": ""}


def test_no_sentence_is_written_if_no_parameter_is_missing() -> None:
    assert missing_sentence(EXPECTED, {*EXPECTED, "another"}) == ""


@pytest.mark.parametrize(
    ("value", "expected", "equal"),
    [
        (1, 1.0, False),
        (True, 1, False),
        (0.1 + 0.2, 0.3, True),
        ("1", "1", True),
        (None, 0.0, False),
        (0.3, 0.4, False),
    ],
)
def test_values_are_equal_only_if_their_types_are_equal(value: object, expected: object, equal: bool) -> None:
    assert same(value, expected) is equal  # type: ignore[arg-type]


def test_differences_distinguish_an_integer_from_a_double() -> None:
    sentences = differences({"a": 1, "b": 2.0}, {"a": 1.0, "b": 2.0, "c": "x"})
    assert sentences == ["a is 1 instead of 1.0", "c is not set instead of 'x'"]


def test_only_numbers_are_converted_to_the_declared_type() -> None:
    declared: dict[str, Value] = {"a": 20.0, "b": 1, "c": "x", "d": True}
    converted = as_declared({"a": 45, "b": 2.0, "c": 3, "d": 1, "e": 4}, declared)
    assert {name: repr(value) for name, value in converted.items()} == {
        "a": "45.0",
        "b": "2",
        "c": "3",
        "d": "1",
        "e": "4",
    }


def test_a_text_of_a_node_is_shortened_to_one_line_of_bounded_length() -> None:
    assert shortened("two\nlines") == "two lines"
    assert len(shortened("x" * 10_000)) == MAX_QUOTE + 1


def test_the_nodes_of_a_file_are_read_in_their_order(tmp_path: Path) -> None:
    path = tmp_path / "fleet.yaml"
    path.write_text("scout:\n  ros__parameters: {a: 1}\n/**:\n  ros__parameters:\n    b: 2.0\n")
    assert list(read_file(path).items()) == [("scout", {"a": 1}), ("/**", {"b": 2.0})]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("a: [", "fleet.yaml is not YAML: .*"),
        ("a: 2026-13-01", "fleet.yaml is not YAML: month must be in 1..12"),
        ("", "fleet.yaml does not name a node"),
        ("- a", "fleet.yaml does not name a node"),
        ("/**:\nros__parameters:\na: 1\n", "nothing is below /\\*\\*: indent ros__parameters"),
        ("ros__parameters:\n  a: 1\n", "ros__parameters is at the left margin"),
        ("/**:\n  ros_parameters:\n    a: 1\n", "ros_parameters is directly below /\\*\\*"),
        ("/**:\n  a: 1\n", "a is directly below /\\*\\*: ROS only reads the values below ros__parameters"),
        ("/**:\n  ros__parameters:\n", "/\\*\\* has no values"),
        ("raise NotImplementedError('x')\n", "fleet.yaml is still to be written"),
        ("# " + "x" * MAX_FILE, "far larger than a parameter file"),
    ],
)
def test_a_parameter_file_that_ros_would_refuse_is_refused_with_the_reason(
    tmp_path: Path, text: str, sentence: str
) -> None:
    path = tmp_path / "fleet.yaml"
    path.write_text(text)
    with pytest.raises(CheckFailed, match=sentence):
        read_file(path)


@pytest.mark.parametrize("key", ["/**/driver", "driver", "/driver"])
def test_parameters_for_a_node_are_found_for_each_way_to_write_its_name(key: str) -> None:
    file = {key: {"speed": 0.3}, "/**": {"speed": 0.1, "range": 2.0}, "other": {"speed": 9.0}}
    assert for_node(file, "driver") == {"speed": 0.3, "range": 2.0}


def test_a_file_that_is_not_installed_is_named(tmp_path: Path) -> None:
    with pytest.raises(CheckFailed, match=r"config/fleet.yaml is not installed"):
        read_file(tmp_path / "config" / "fleet.yaml")


SCALARS = [
    "1",
    "1.5",
    "true",
    "0x",
    "0b_",
    "1:60",
    "2026-13-01",
    "~",
    "[",
    "*a",
    "&a",
    "!!int x",
    "!!binary =",
    "<<: 1",
    "? x",
    "9" * 5000,
]
VALUE = st.sampled_from(SCALARS) | st.text(max_size=6)


@pytest.mark.fuzz
@given(st.lists(st.tuples(st.sampled_from(["/**:", "  ros__parameters:", "    a: ", "    - ", ""]), VALUE), max_size=6))
def test_any_text_is_a_parameter_file_or_refused(
    tmp_path_factory: pytest.TempPathFactory, lines: list[tuple[str, str]]
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_text("\n".join(f"{key}{value}" for key, value in lines), encoding="utf-8", errors="surrogatepass")
    with contextlib.suppress(CheckFailed):
        read_file(path)


def test_overrides_are_written_as_yaml() -> None:
    values: dict[str, Value] = {"hot": math.nan, "cool": 0.5, "on": True, "name": "07", "window": 2}
    overrides = ["hot:=.nan", "cool:=0.5", "on:=true", "name:='07'", "window:=2"]
    assert override_arguments(values) == [word for override in overrides for word in ("-p", override)]
