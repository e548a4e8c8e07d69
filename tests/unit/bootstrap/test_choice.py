"""The set-up uses the ROS that the shell has, or the wheels, or refuses with a reason."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import pytest

from autograder import bootstrap
from autograder.bootstrap import Interpreter, SetUpError
from autograder.ros.distribution import DISTRIBUTION

PY312 = Interpreter("/usr/bin/python3.12", "3.12", "3.12.1 (main)", ".cpython-312-x86_64-linux-gnu.so")
LOCK = """\
numpy==2.5.0 ; python_full_version >= '3.12' \\
    --hash=sha256:00
ros-rclpy==7.1.6 \\
    --hash=sha256:01 \\
    --hash=sha256:02
ros-wheels-bootstrapper==0.1.2 \\
    --hash=sha256:03
rosbags==0.10 \\
    --hash=sha256:04
"""


@pytest.mark.parametrize("version", ["3.10", "3.11", "3.12", "3.13"])
def test_each_python_that_ros_has_wheels_for_is_accepted(version: str) -> None:
    bootstrap.check_machine(version, "Linux", "x86_64")


@pytest.mark.promise("You need Linux on x86-64, Python 3.10 to 3.13")
@pytest.mark.parametrize("version", ["2.7", "3.9", "3.14"])
def test_an_unsupported_python_is_refused_with_the_supported_ones(version: str) -> None:
    with pytest.raises(SetUpError, match=rf"Python {version} is not supported: .* 3\.10 to 3\.13\. .*3\.12"):
        bootstrap.check_machine(version, "Linux", "x86_64")


@pytest.mark.promise("You need Linux on x86-64, Python 3.10 to 3.13", "On macOS, Windows or ARM, open the")
@pytest.mark.parametrize("machine", [("Darwin", "arm64"), ("Windows", "AMD64"), ("Linux", "aarch64")])
def test_an_unsupported_machine_is_refused_with_the_supported_ones(machine: tuple[str, str]) -> None:
    with pytest.raises(SetUpError, match=f"this is {' '.join(machine)}: use the container"):
        bootstrap.check_machine("3.12", *machine)


@pytest.fixture
def ros(tmp_path: Path) -> Path:
    """The site-packages folder of a ROS whose rclpy was built for Python 3.12."""
    site = tmp_path / "opt/ros/any/lib/python3.12/site-packages"
    (site / "rclpy").mkdir(parents=True)
    (site / "rclpy" / f"_rclpy_pybind11{PY312.suffix}").touch()
    return site


VENV = Path("/course/.venv")


def test_without_a_sourced_ros_the_wheels_are_used() -> None:
    assert bootstrap.sourced_ros({}, VENV, PY312) is None
    assert bootstrap.sourced_ros({"ROS_DISTRO": "humble", "PYTHONPATH": "/my/code"}, VENV, PY312) is None


def test_this_projects_own_environment_does_not_count_as_sourced() -> None:
    environment = {
        "ROS_DISTRO": DISTRIBUTION.name,
        "AMENT_PREFIX_PATH": str(VENV),
        "PYTHONPATH": str(VENV / "lib/site-packages"),
    }
    assert bootstrap.sourced_ros(environment, VENV, PY312) is None


def test_a_students_workspace_over_the_wheels_does_not_count_as_sourced() -> None:
    environment = {
        "ROS_DISTRO": DISTRIBUTION.name,
        "AMENT_PREFIX_PATH": f"/ws/install/robot:{VENV}",
        "PYTHONPATH": "/ws/install",
    }
    assert bootstrap.sourced_ros(environment, VENV, PY312) is None


@pytest.mark.promise("If a ROS 2 Jazzy installation is sourced, the course uses it.")
def test_a_sourced_ros_is_used(ros: Path) -> None:
    sourced = {
        "ROS_DISTRO": DISTRIBUTION.name,
        "AMENT_PREFIX_PATH": "/opt/ros/sourced",
        "PYTHONPATH": f"/elsewhere:{ros}",
    }
    assert bootstrap.sourced_ros(sourced, VENV, PY312) == str(ros)


@pytest.mark.parametrize(
    "variables",
    [
        {"ROS_DISTRO": "humble", "AMENT_PREFIX_PATH": "/opt/ros/humble"},
        {"ROS_DISTRO": "noetic", "ROS_PACKAGE_PATH": "/opt/ros/noetic/share"},
    ],
)
def test_another_distribution_is_refused_by_name(variables: dict[str, str]) -> None:
    reason = f"distribution is {variables['ROS_DISTRO']}, but the course needs {DISTRIBUTION.title}: use a shell"
    with pytest.raises(SetUpError, match=reason):
        bootstrap.sourced_ros(variables, VENV, PY312)


def test_a_ros_of_an_unknown_distribution_is_rejected(ros: Path) -> None:
    with pytest.raises(SetUpError, match=f"is unknown, but the course needs {DISTRIBUTION.title}"):
        bootstrap.sourced_ros({"PYTHONPATH": str(ros)}, VENV, PY312)


def test_a_ros_for_another_python_is_refused_with_the_python_that_fits(ros: Path) -> None:
    py311 = replace(PY312, version="3.11", suffix=".cpython-311-x86_64-linux-gnu.so")
    with pytest.raises(SetUpError, match=r"is not for Python 3\.11: run `make PYTHON=python3\.12`"):
        bootstrap.sourced_ros({"ROS_DISTRO": DISTRIBUTION.name, "PYTHONPATH": str(ros)}, VENV, py311)


def test_only_ros_itself_is_removed_from_the_lock() -> None:
    remaining = bootstrap.without_ros(LOCK)
    assert [line.split("==")[0] for line in remaining.splitlines() if "==" in line] == ["numpy", "rosbags"]
    assert "--hash=sha256:00" in remaining
    assert "--hash=sha256:01" not in remaining
    assert "--hash=sha256:04" in remaining


def test_children_see_the_proxy_but_neither_foreign_modules_nor_the_wheels_libraries() -> None:
    environment = {
        "HTTPS_PROXY": "proxy:3128",
        "PIP_CERT": "/cert.pem",
        "PYTHONPATH": "/opt/ros/sourced/lib",
        "PYTHONHOME": "/odd",
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
        "LD_LIBRARY_PATH": "/other/.venv/lib",
    }
    assert bootstrap.child_environment(environment) == {
        "HTTPS_PROXY": "proxy:3128",
        "PIP_CERT": "/cert.pem",
        "PIP_DISABLE_PIP_VERSION_CHECK": "1",
    }
    assert bootstrap.child_environment({"LD_LIBRARY_PATH": "/opt/python/lib"})["LD_LIBRARY_PATH"] == "/opt/python/lib"


def test_a_python_or_course_that_other_users_cannot_read_is_named_with_the_remedy() -> None:
    with tempfile.TemporaryDirectory(dir="/tmp") as scratch:
        folder = Path(scratch).resolve()
        (closed := folder / "closed").mkdir()
        folder.chmod(0o755)
        closed.chmod(0o700)
        python, course = folder / "python3", folder / "course"
        assert bootstrap.closed_to_other_users(python, course) is None
        assert bootstrap.closed_to_other_users(closed / "bin" / "python3", course) == (
            f"other users cannot run .venv, because they cannot enter {closed}, which contains {closed}/bin/python3; "
            "run `make setup PYTHON=/usr/bin/python3`"
        )
        problem = bootstrap.closed_to_other_users(python, closed / "course")
        assert problem is not None
        assert problem.endswith("/closed/course; move the course, to /srv for example, and run `make setup` there")
