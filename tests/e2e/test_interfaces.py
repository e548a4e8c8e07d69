"""Plain classes, made from a package's definitions, exchange messages with a node that uses the built package."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import pytest

from autograder.building.interfaces import load_interfaces
from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.submission.exercise_stubs import CODE_STUB
from tests.e2e.sandbox_support import in_worker_sandbox

PACKAGE, OUTER = "my_robot_interfaces", "fleet_interfaces"
TIMEOUT = 20.0  # seconds

NODE = """
import rclpy
from my_robot_interfaces.msg import RobotStatus
rclpy.init()
node = rclpy.create_node('echo')
out = node.create_publisher(RobotStatus, 'out', 10)
def answer(message):
    message.battery_level += 1
    out.publish(message)
node.create_subscription(RobotStatus, 'in', answer, 10)
rclpy.spin(node)
"""


def _workspace(scratch: Path) -> Any:
    from autograder.author.verification.mutants import write_reference
    from autograder.harness import Workspace
    from autograder.ros import activate

    (scratch / "home").mkdir()
    domain = int(os.environ["ROS_DOMAIN_ID"])
    workspace = Workspace(scratch / "ws", activate(), scratch / "home", domain=domain)
    write_reference((PACKAGE,), workspace.root)
    return workspace


def exchange_messages(scratch: Path) -> dict[str, Any]:
    """Build the package with colcon, and exchange messages of the plain class with a sandboxed node."""
    import sys

    import rclpy

    from autograder.building.build import build as colcon
    from autograder.run.sandbox.launcher import launch

    workspace = _workspace(scratch)
    colcon(workspace, (PACKAGE,))
    program = workspace.scratch / "node.py"
    program.write_text(NODE)
    outer = workspace.root / "src" / OUTER
    (outer / "msg").mkdir(parents=True)
    (outer / "package.xml").write_text(f"<package format='3'><name>{OUTER}</name></package>")
    (outer / "msg" / "Fleet.msg").write_text(f"{PACKAGE}/RobotStatus[] robots\n")
    fleet = load_interfaces(workspace, OUTER).msg.Fleet
    module = load_interfaces(workspace, PACKAGE)
    kind, received = module.msg.RobotStatus, list[Any]()
    rclpy.init()
    node = rclpy.create_node("grader")
    out = node.create_publisher(kind, "in", 10)
    node.create_subscription(kind, "out", received.append, 10)
    with launch([sys.executable, str(program)], workspace.sandbox()) as process:
        deadline = time.monotonic() + TIMEOUT
        while not received and time.monotonic() < deadline:
            if out.get_subscription_count() and node.count_publishers("out"):
                out.publish(kind(robot_name="R2", battery_level=41))
            rclpy.spin_once(node, timeout_sec=0.1)
        hashes = {str(end.topic_type_hash) for end in node.get_publishers_info_by_topic("out")}
        hashes |= {str(end.topic_type_hash) for end in node.get_publishers_info_by_topic("in")}
        output = process.output
    levels = [message.battery_level for message in fleet(robots=received[:1]).robots]
    node.destroy_node()
    rclpy.shutdown()
    return {"levels": levels, "hashes": sorted(hashes), "output": output}


@pytest.mark.promise("It uses the real ROS 2 Jazzy: rclpy, DDS, rosidl and colcon, installed by pip.")
def test_both_ends_have_the_same_type_hash_and_exchange_messages() -> None:
    answer = in_worker_sandbox(exchange_messages)
    assert answer["levels"] == [42], answer
    assert len(answer["hashes"]) == 1, answer


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("int32 Speed", ["src/my_robot_interfaces", "msg/RobotStatus.msg", "int32 Speed"]),
        ("std_mgs/Header header", ["there is no package std_mgs"]),
        ("std_msgs/Headr header", ["std_msgs has no message Headr"]),
    ],
)
def test_an_invalid_definition_is_a_student_error(tmp_path: Path, line: str, words: list[str]) -> None:
    workspace = _workspace(tmp_path)
    (workspace.root / "src" / PACKAGE / "msg" / "RobotStatus.msg").write_text(f"{line}\n")
    with pytest.raises(StudentError) as excinfo:
        load_interfaces(workspace, PACKAGE)
    assert excinfo.value.diagnosis.kind is Kind.HALF_WRITTEN_PACKAGE
    assert all(word in excinfo.value.diagnosis.sentence for word in words), excinfo.value.diagnosis.sentence


def test_a_missing_package_is_named(tmp_path: Path) -> None:
    with pytest.raises(StudentError, match=r"ghost_msgs is missing: src contains my_robot_interfaces\."):
        load_interfaces(_workspace(tmp_path), "ghost_msgs")


def test_the_stub_of_a_definition_is_reported_as_still_to_be_written(tmp_path: Path) -> None:
    workspace = _workspace(tmp_path)
    (workspace.root / "src" / PACKAGE / "msg" / "RobotStatus.msg").write_text(CODE_STUB)
    with pytest.raises(StudentError, match=r"msg/RobotStatus\.msg is still to be written"):
        load_interfaces(workspace, PACKAGE)
