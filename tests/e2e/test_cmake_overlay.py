"""The CMake overlay covers every generator of ROS, and interface packages that are built with it work."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.building.build import build
from autograder.building.cmake_overlay import COMPILED, EXCLUDED, write_overlay
from autograder.course_paths import SOLUTIONS
from autograder.harness import Workspace
from autograder.ros import activate


@pytest.fixture
def overlay(tmp_path: Path) -> Path:
    return write_overlay(activate().prefixes, tmp_path / "overlay")


def test_every_generator_of_this_ros_has_its_config(overlay: Path) -> None:
    present = {
        name for name in (*COMPILED, *EXCLUDED) if any((p / "share" / name).is_dir() for p in activate().prefixes)
    }
    assert present >= set(COMPILED)
    assert {path.name for path in (overlay / "share").iterdir()} == present


def test_the_overlay_has_no_config_for_a_generator_that_ros_lacks(tmp_path: Path) -> None:
    assert not list(write_overlay((tmp_path / "no_ros",), tmp_path / "overlay").glob("*/*"))


# All kinds of fields, nested in each other: sources that are compiled as one must not define a name twice.
FIELDS = ("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int64", "uint64", "string", "wstring")
DEFINITIONS = {
    "msg/Basics.msg": "{} f{}",
    "msg/Arrays.msg": "{}[3] f{}",
    "msg/Sequences.msg": "{}[] f{}",
    "msg/Bounded.msg": "{}[<=4] f{}",
    "msg/Nested.msg": "Basics one\nBasics[] more\nArrays[2] two\nstring<=5 brief\nstd_msgs/Header header",
    "msg/Nothing.msg": "",
    "srv/Ask.srv": "Basics ask\n---\nNested answer",
    "srv/Stop.srv": "---",
    "action/Move.action": "Basics goal\n---\nNested result\n---\nBasics[] seen",
    "action/Count.action": "int32 order\n---\nint32[] sequence\n---\nint32[] partial",
}
USE = """
import inspect
from my_robot_interfaces import action, msg, srv
from rclpy.serialization import deserialize_message, serialize_message
import rclpy
from rclpy.action import ActionClient, ActionServer

plain = [kind for _, kind in inspect.getmembers(msg, inspect.isclass)]
parts = [part for kind in (srv.Ask, srv.Stop) for part in (kind.Request, kind.Response)]
parts += [part for kind in (action.Move, action.Count) for part in (kind.Goal, kind.Result, kind.Feedback)]
for kind in plain + parts:
    assert deserialize_message(serialize_message(kind()), kind) == kind(), kind
rclpy.init()
node = rclpy.create_node("user")
node.create_service(srv.Ask, "ask", lambda request, response: response)
server, client = ActionServer(node, action.Move, "move", lambda goal: None), ActionClient(node, action.Count, "count")
node.create_publisher(msg.Nested, "nested", 1).publish(msg.Nested())
print(len(plain), len(parts))
"""


def test_a_package_of_all_kinds_of_fields_is_built_and_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    name = "my_robot_interfaces"
    package = tmp_path / "ws" / "src" / name
    (tmp_path / "ws" / "home").mkdir(parents=True)
    package.mkdir(parents=True)
    shutil.copy(SOLUTIONS / name / "package.xml", package)
    for path, text in DEFINITIONS.items():
        (package / path).parent.mkdir(exist_ok=True)
        lines = [text.format(kind, kind) for kind in FIELDS] if "{}" in text else [text]
        (package / path).write_text("\n".join(lines) + "\n")
    files = "\n".join(f'"{path}"' for path in DEFINITIONS)
    reference = (SOLUTIONS / name / "CMakeLists.txt").read_text()
    before, _, after = reference.partition("rosidl_generate_interfaces(${PROJECT_NAME}")
    assert after
    generate = f"rosidl_generate_interfaces(${{PROJECT_NAME}}\n{files}\n"
    (package / "CMakeLists.txt").write_text(before + generate + after[after.index("DEPENDENCIES") :])
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path / "ws" / "home")
    assert build(workspace, (name,)).ok
    process = subprocess.run([sys.executable, "-c", USE], env=workspace.environment(), text=True, capture_output=True)
    assert process.returncode == 0, process.stderr
    assert process.stdout.split() == ["6", "10"]
