"""`drive` with parameters, and `side_by_side`, as students call them in a notebook."""

from __future__ import annotations

from pathlib import Path

import pytest
from std_msgs.msg import Float32

from autograder.author.verification.mutants import write_reference
from autograder.exceptions import UsageError
from autograder.notebook import drive, side_by_side
from autograder.notebook.driving import DriveReport
from autograder.notebook.notices import Notice

PROGRAM = ("my_robot_package", "configured_node")
WALL = 3.0  # m: the east wall of the empty room, straight ahead of the start


@pytest.fixture(scope="session")
def reference_workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reference")
    write_reference((PROGRAM[0],), folder)
    return folder


def final_distance(report: DriveReport | Notice) -> float:
    """Return the robot's final distance from the wall, in metres."""
    assert isinstance(report, DriveReport)
    return WALL - float(report.recording.poses[-1, 0, 0])


def test_a_parameter_changes_where_the_robot_stops(reference_workspace: Path) -> None:
    drives = {
        f"{distance} m": drive(
            *PROGRAM,
            seconds=20,
            parameters={"safety_distance": distance, "slow_distance": distance + 0.5},
            workspace=reference_workspace,
        )
        for distance in (0.5, 1.5)
    }
    assert [final_distance(report) for report in drives.values()] == pytest.approx([0.5, 1.5], abs=0.02)
    lines = [report.recording.log_lines[0] for report in drives.values() if isinstance(report, DriveReport)]
    assert len(lines) == 2
    assert {text for _, text in lines} == {"[INFO] [configured_node]: DefaultRobot is ready"}
    assert lines[0][0] == lines[1][0] <= 0.1
    picture = side_by_side(drives)
    assert not isinstance(picture, Notice)
    assert "0.5 m: " in picture.alt
    assert "1.5 m: " in picture.alt


def test_a_parameter_file_gives_a_robot_the_parameters_of_its_name(reference_workspace: Path) -> None:
    fleet = reference_workspace / "src/my_robot_package/config/fleet_params.yaml"
    porter = drive(*PROGRAM, seconds=20, name="porter", parameters=fleet, workspace=reference_workspace)
    assert isinstance(porter, DriveReport)
    assert "Porter is ready" in porter.output
    assert final_distance(porter) == pytest.approx(1.0, abs=0.02)


def test_parameters_that_the_node_rejects_are_reported_in_a_sentence(reference_workspace: Path) -> None:
    refused = drive(*PROGRAM, seconds=1, parameters={"safety_distance": 2.0}, workspace=reference_workspace)
    assert isinstance(refused, Notice)
    assert "safety_distance (2 m) must be below slow_distance (1 m)" in refused.sentence
    assert side_by_side({"refused": refused}) is refused


def test_a_missing_parameter_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"parameter file .*nowhere.yaml not found: give its path"):
        drive(*PROGRAM, parameters=tmp_path / "nowhere.yaml")


def test_a_parameter_value_of_an_unsupported_type_is_named() -> None:
    with pytest.raises(UsageError, match="a parameter must be a bool, int, float, str or a list of these, not complex"):
        drive(*PROGRAM, parameters={"speed": 1j})


LISTENER = '''"""Drive as fast as /limit says."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Float32


class Listener(Node):
    def __init__(self):
        super().__init__('listener')
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Float32, 'limit', self.on_limit, 10)

    def on_limit(self, limit):
        command = Twist()
        command.linear.x = limit.data
        self.publisher.publish(command)


def main():
    rclpy.init()
    rclpy.spin(Listener())
'''


def test_each_step_publishes_the_messages_that_the_notebook_returns(reference_workspace: Path) -> None:
    package = reference_workspace / "src" / PROGRAM[0] / PROGRAM[0]
    (package / "listener.py").write_text(LISTENER)
    setup = package.parent / "setup.py"
    text = setup.read_text()
    assert text.count("'console_scripts': [") == 1
    setup.write_text(
        text.replace("'console_scripts': [", f"'console_scripts': ['listener = {PROGRAM[0]}.listener:main',")
    )

    def limit(t: float) -> dict[str, Float32] | None:
        return {"/limit": Float32(data=0.25)} if 1.0 <= t < 2.0 else None

    report = drive(PROGRAM[0], "listener", seconds=3, each_step=limit, workspace=reference_workspace)
    assert isinstance(report, DriveReport), report
    assert [(round(t, 1), v) for t, v, _ in report.commands] == [(round(1 + n / 10, 1), 0.25) for n in range(10)]
