"""The names that a new package or node may not have."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.author.course.new import write_chapter
from autograder.author.course.package_names import is_package_name, owner_of
from autograder.exceptions import UsageError


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("json", "a module of Python's standard library"),
        ("launch", "a package of ROS"),
        ("rclpy", "a package of ROS"),
        ("std_msgs", "a package of ROS"),
        ("slam_toolbox", "a package of ROS"),  # it has no wheel; students meet it later
        ("pyyaml", "a package that pip installed"),
        ("import_linter", "a package that pip installed"),
        ("yaml", "a module that Python can already import"),
        ("autograder", "a module that Python can already import"),
        ("torchvision", "a package of PyPI that robots often use"),
        ("install", "a name that colcon, setuptools or pytest uses"),
    ],
)
def test_a_name_that_exists_elsewhere_is_taken(name: str, owner: str) -> None:
    assert owner_of(name) == owner


@pytest.mark.parametrize("name", ["nearest", "mapping", "launch_lab", "my_robot_package"])
def test_other_names_are_free(name: str) -> None:
    assert owner_of(name) == ""


def test_a_plain_folder_on_the_path_does_not_occupy_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mapping").mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    assert owner_of("mapping") == ""


@pytest.mark.parametrize("name", ["", "2d", "Robot", "a-b", "a__b", "a_", "import", "café", "a/b"])
def test_a_name_that_ros_or_python_does_not_allow_is_refused(name: str) -> None:
    assert not is_package_name(name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"package": "02_json"},
            "'02_json' is not a package name: use lower-case letters, digits and single underscores",
        ),
        ({"package": "json"}, "Choose another name: autograder new chapter 40_reading --package my_reading"),
        ({"node": "rclpy"}, "a node cannot be called 'rclpy', which is a package of ROS"),
        ({"node": "laser_scan"}, "a node 'laser_scan' would have the class LaserScan, which its module also imports."),
    ],
)
def test_a_package_or_node_whose_name_is_taken_is_rejected(options: dict[str, str], message: str) -> None:
    with pytest.raises(UsageError) as excinfo:
        write_chapter("40_reading", **options)
    assert message in str(excinfo.value)
