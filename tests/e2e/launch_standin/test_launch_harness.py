"""The launch harness reports the nodes that launch files start, and the processes that they leave running."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from std_msgs.msg import String

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.harness.launch import LaunchHarness
from autograder.probes import launch_probe, short_lived
from autograder.ros import environment
from autograder.run.sandbox.procfs import children
from autograder.suite import CheckFailed

PATIENCE = 60.0  # seconds: a deadline, not an expectation
LEAVES_ONE = """
import subprocess
from launch import LaunchDescription
from launch.actions import TimerAction


def generate_launch_description():
    subprocess.Popen(["sleep", "600"])
    return LaunchDescription([TimerAction(period=600.0, actions=[])])
"""
FLOODS = """
while True:
    print("x" * 1000)
"""

SPIN = """
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    rclpy.try_shutdown()
"""
STUBBORN = f"""#!{sys.executable}
import pathlib
import signal
import sys

import rclpy
from rclpy.executors import ExternalShutdownException

rclpy.init()
marker = pathlib.Path.home() / 'marker'
if sys.argv[1] == 'always' or not marker.exists():
    marker.touch()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
node = rclpy.create_node('stubborn')
{SPIN}"""
RACE_IN_SHUTDOWN = f"""#!{sys.executable}
import pathlib
import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException


class StaleHandle:
    # A handle that claims to be valid although rclpy's thread for signals has just shut its context down.
    def __init__(self, handle):
        self._handle = handle
        self.shutdown = handle.shutdown

    def __enter__(self):
        self._handle.__enter__()

    def __exit__(self, *error):
        self._handle.__exit__(*error)

    def ok(self):
        return True


rclpy.init()
marker = pathlib.Path.home() / 'marker'
node = rclpy.create_node('racing')
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
context = rclpy.get_default_context()
while context.ok():
    time.sleep(0.01)
if sys.argv[1] == 'always' or not marker.exists():
    marker.touch()
    context._Context__context = StaleHandle(context.handle)
rclpy.try_shutdown()
"""
ECHO = f"""#!{sys.executable}
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node('echo')
publisher = node.create_publisher(String, '/out', 10)
node.create_subscription(String, '/in', publisher.publish, 10)
{SPIN}"""
SLOW = f"""#!{sys.executable}
import time

import rclpy
from rclpy.executors import ExternalShutdownException

rclpy.init()
node = rclpy.create_node('slow')
time.sleep(2.0)
{SPIN}"""
LATE = f"""#!{sys.executable}
import time

import rclpy

time.sleep(1.5)
rclpy.init()
rclpy.spin(rclpy.create_node('late'))
"""
FORKS = "#!/bin/sh\n[ $1 = with_beacon ] && exit\n(while sleep 0.1; do :; done) &\nwait\n"
LAUNCH_FILE = """
from launch import LaunchDescription
from launch.conditions import LaunchConfigurationEquals
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    how = LaunchConfiguration('how')
    # A program that ignores both signals is killed soon. One that heeds them has the default time on a busy machine.
    given = Node(package='fleet', executable='given', arguments=[how], sigkill_timeout='0.5')
    beacon = Node(package='fleet', executable='beacon', condition=LaunchConfigurationEquals('how', 'with_beacon'))
    return LaunchDescription([given, beacon])
"""


@pytest.fixture
def workspace(install_fleet: Callable[[Path], None], tmp_path: Path, ros_domain: int) -> Workspace:
    """A workspace in which the package `fleet` is installed."""
    install_fleet(tmp_path / "ws" / "install" / "fleet")
    (tmp_path / "scratch").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "scratch", domain=ros_domain)


def test_nodes_parameters_messages_and_programs_are_seen_and_ctrl_c_ends_them(workspace: Workspace) -> None:
    arguments = {"name": "lamp", "rate": "8.5"}
    with LaunchHarness(workspace, "fleet", "single.launch.py", arguments, subscribes={"/beat": String}) as harness:
        launch_probe.expect_nodes(harness, ["/lamp"])
        assert harness.parameters("/lamp", ["rate", "label"]) == {"rate": 8.5, "label": "42"}
        assert harness.parameters("/lamp", ["rate", "absent"]) == {"rate": 8.5, "absent": None}
        assert harness.parameters("/nobody", ["rate"], seconds=0.5) is None
        assert harness.wait_for(lambda: len(harness.messages("/beat")) > 1, PATIENCE)
        assert harness.publishers("/beat") == ["/lamp"]
        assert harness.subscribers("/beat") == []
        assert [(program.package, program.name) for program in harness.programs()] == [("fleet", "beacon")]
        assert harness.status is None
        launch_probe.expect_clean_stop(harness)
        assert harness.programs() == []


def test_a_wrong_node_or_parameter_is_reported_with_the_actual_one(workspace: Workspace) -> None:
    with LaunchHarness(workspace, "fleet", "single.launch.py", {"name": "lamp"}) as harness:
        with pytest.raises(CheckFailed) as excinfo:
            launch_probe.expect_nodes(harness, ["/robot1/lamp"])
        assert excinfo.value.message == "The graph contains /lamp: /lamp runs instead of /robot1/lamp."
        with pytest.raises(CheckFailed, match=r"/lamp has rate = 4\.0, instead of 5\.0"):
            launch_probe.expect_parameters(harness, "/lamp", {"rate": 5.0})
        with pytest.raises(CheckFailed, match="/lamp has label = '42', instead of 42"):
            launch_probe.expect_parameters(harness, "/lamp", {"label": 42})


def test_a_program_that_has_forked_is_still_one_program(install_program: Callable[[str], Workspace]) -> None:
    with LaunchHarness(install_program(FORKS), "fleet", "given.launch.py", {"how": "once"}) as harness:
        assert harness.wait_for(lambda: any(children(program.pid) for program in harness.programs()), PATIENCE)
        assert [program.name for program in harness.programs()] == ["given"]
        assert harness.kill("given", signal.SIGTERM) == 1
        assert harness.wait_for(lambda: harness.status is not None, PATIENCE)
        assert harness.left() == ()


def test_a_program_hangs_only_if_it_does_not_end_by_itself(
    install_program: Callable[[str], Workspace], monkeypatch: pytest.MonkeyPatch
) -> None:
    installed = install_program(FORKS)
    with (
        LaunchHarness(installed, "fleet", "given.launch.py", {"how": "once"}) as harness,
        monkeypatch.context() as patch,
    ):
        patch.setattr(short_lived, "START_SECONDS", 5.0)
        assert short_lived.hangs(harness, "given")
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "with_beacon"}) as harness:
        assert not short_lived.hangs(harness, "given")
        assert not short_lived.hangs(harness, "absent")


def test_a_killed_program_disappears_and_an_idle_launch_ends(workspace: Workspace) -> None:
    with LaunchHarness(workspace, "fleet", "single.launch.py") as harness:
        launch_probe.expect_nodes(harness, ["/beacon"])
        assert harness.kill("beacon", signal.SIGKILL) == 1
        assert harness.wait_for(lambda: harness.status is not None, PATIENCE)
        assert launch_probe.failure(harness.output) == "beacon died with exit code -9"
        assert harness.kill("beacon") == 0


def test_a_process_that_a_launch_leaves_running_is_named(workspace: Workspace) -> None:
    installed = launch_probe.with_files(workspace, "leaves", "fleet", {"launch/leaves_one.launch.py": LEAVES_ONE})
    with LaunchHarness(installed, "fleet", "leaves_one.launch.py") as harness:
        assert harness.wait_for(lambda: "verbosity" in harness.output, PATIENCE)
        with pytest.raises(CheckFailed, match="It ended, but left a process running: sleep 600"):
            launch_probe.expect_clean_stop(harness)
    assert not (workspace.install / "fleet/share/fleet/launch/leaves_one.launch.py").exists()


@pytest.fixture
def install_program(workspace: Workspace) -> Callable[[str], Workspace]:
    """Return a function that adds a program to `fleet`, with a launch file, `given.launch.py`, that starts it."""

    def install(text: str) -> Workspace:
        installed = launch_probe.with_files(workspace, "given", "fleet", {"launch/given.launch.py": LAUNCH_FILE})
        program = installed.install / "fleet/lib/fleet/given"
        program.write_text(text)
        program.chmod(0o755)
        return installed

    return install


def test_a_reliable_subscription_hears_only_a_publisher_that_is_reliable(
    install_program: Callable[[str], Workspace],
) -> None:
    installed = install_program(ECHO)
    topics = {"subscribes": {"/out": String}, "publishes": {"/in": String, "/sensor": String}}

    def is_answered(harness: LaunchHarness) -> bool:
        harness.publish("/in", String(data="hello"))
        return bool(harness.messages("/out"))

    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "echo"}, **topics, qos={"/in": 10}) as harness:
        assert harness.wait_for(lambda: is_answered(harness), PATIENCE), harness.output
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "echo"}, **topics) as harness:
        assert harness.wait_for(lambda: "/echo" in harness.subscribers("/in"), PATIENCE), harness.output
        assert not harness.wait_for(lambda: is_answered(harness), 1.0)


def test_a_program_whose_node_appears_late_is_not_overlooked(install_program: Callable[[str], Workspace]) -> None:
    late = LaunchHarness(install_program(LATE), "fleet", "given.launch.py", {"how": "with_beacon"})
    with late as harness, pytest.raises(CheckFailed, match="/late is not expected"):
        launch_probe.expect_nodes(harness, ["/beacon"])


def test_ctrl_c_waits_for_a_node_that_is_visible_but_not_yet_constructed(
    install_program: Callable[[str], Workspace],
) -> None:
    with LaunchHarness(install_program(SLOW), "fleet", "given.launch.py", {"how": "once"}) as harness:
        launch_probe.expect_nodes(harness, ["/slow"])
        launch_probe.expect_clean_stop(harness)


def test_a_killed_node_gets_a_second_launch_whose_result_counts(install_program: Callable[[str], Workspace]) -> None:
    installed = install_program(STUBBORN)
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "once"}) as harness:
        launch_probe.expect_nodes(harness, ["/stubborn"])
        launch_probe.expect_clean_stop(harness)
        assert "exit code -9" in harness.output
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "always"}) as harness:
        launch_probe.expect_nodes(harness, ["/stubborn"])
        with pytest.raises(CheckFailed, match=r"not every process ended cleanly: given with -9"):
            launch_probe.expect_clean_stop(harness)


def test_a_race_in_the_shutdown_gets_a_second_launch_whose_result_counts(
    install_program: Callable[[str], Workspace],
) -> None:
    installed = install_program(RACE_IN_SHUTDOWN)
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "once"}) as harness:
        launch_probe.expect_nodes(harness, ["/racing"])
        launch_probe.expect_clean_stop(harness)
        assert "rcl_shutdown already called" in harness.output
    with LaunchHarness(installed, "fleet", "given.launch.py", {"how": "always"}) as harness:
        launch_probe.expect_nodes(harness, ["/racing"])
        with pytest.raises(CheckFailed, match=r"not every process ended cleanly: given with 1"):
            launch_probe.expect_clean_stop(harness)


def test_a_launch_file_that_is_missing_or_broken_ends_the_launch_with_a_reason(workspace: Workspace) -> None:
    with pytest.raises(
        CheckFailed, match=r"`ros2 launch -s fleet absent.launch.py` fails: file 'absent.launch.py' was"
    ):
        launch_probe.declared_arguments(workspace, "fleet", "absent.launch.py")
    with LaunchHarness(workspace, "fleet", "broken.launch.py") as harness:
        with pytest.raises(
            CheckFailed, match=r"No node is running; /light is missing. The launch reported: .*'config' is not"
        ):
            launch_probe.expect_nodes(harness, ["/light"])
        assert harness.status == 1


def test_the_arguments_of_a_launch_file_are_shown(workspace: Workspace) -> None:
    arguments = launch_probe.declared_arguments(workspace, "fleet", "arguments.launch.py")
    assert list(arguments) == ["robot", "mode", "topic"]
    assert arguments["mode"].choices == ("drive", "park")


def test_a_launch_that_prints_without_end_raises_a_student_error(workspace: Workspace) -> None:
    installed = launch_probe.with_files(workspace, "floods", "fleet", {"launch/floods.launch.py": FLOODS})
    with LaunchHarness(installed, "fleet", "floods.launch.py") as harness, pytest.raises(StudentError) as excinfo:
        harness.wait_for(lambda: False, PATIENCE)
    assert excinfo.value.diagnosis.kind is Kind.FLOODED_OUTPUT
