"""colcon builds a student's interface packages once for all workspaces with the same packages."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.course_paths import SOLUTIONS
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.ros import activate

INTERFACES, NODES = "my_robot_interfaces", "my_robot_package"
USE = """
import rclpy
from my_robot_interfaces.msg import RobotStatus
rclpy.init()
node = rclpy.create_node("user")
node.create_publisher(RobotStatus, "status", 1).publish(RobotStatus(robot_name="Wall-hugger"))
rclpy.shutdown()
"""


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "autograder" / "bundles"


def make_workspace(root: Path) -> Workspace:
    for name in (INTERFACES, NODES):
        shutil.copytree(SOLUTIONS / name, root / "src" / name)
    (root / "home").mkdir()
    return Workspace(root, activate(), root / "home")


def test_an_interface_bundle_is_built_once_and_works_in_each_workspace(tmp_path: Path, own_cache: Path) -> None:
    first, second = make_workspace(tmp_path / "first"), make_workspace(tmp_path / "second")
    assert build(first, (NODES,)).ok
    (bundle,) = own_cache.glob("*/install")
    shutil.rmtree(first.root)  # a file that still refers to this folder would fail now
    assert build(second, (NODES,)).ok
    assert [path for path in own_cache.glob("*/install")] == [bundle]
    process = subprocess.run([sys.executable, "-c", USE], env=second.environment(), text=True, capture_output=True)
    assert process.returncode == 0, process.stderr


def test_an_interface_bundle_that_does_not_build_is_a_student_error_and_is_not_cached(
    tmp_path: Path, own_cache: Path
) -> None:
    broken = make_workspace(tmp_path / "broken")
    cmake = broken.root / "src" / INTERFACES / "CMakeLists.txt"
    cmake.write_text(cmake.read_text().replace("find_package(rosidl_default_generators", "find_package(no_such_thing"))
    with pytest.raises(StudentError) as excinfo:
        build(broken, (NODES,))
    assert excinfo.value.diagnosis.kind is Kind.BUILD_FAILED
    assert "no_such_thing" in excinfo.value.diagnosis.detail
    assert list(own_cache.glob("*/install")) == []
