"""Each reference package builds, passes the linters and its own tests, and its programs start and end cleanly."""

from __future__ import annotations

import ast
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from xml.etree import ElementTree

import pytest
from std_msgs.msg import String

from autograder.course_paths import SOLUTIONS
from autograder.harness import Workspace
from autograder.harness.launch import LaunchHarness
from autograder.probes import launch_probe
from autograder.ros import environment
from autograder.submission.packages import find_packages
from tests.e2e.conftest import Terminal

PACKAGES, _ = find_packages(SOLUTIONS)
PYTHON = [name for name, folder in PACKAGES.items() if (folder / "setup.py").is_file()]
MESSAGES = [name for name in PACKAGES if name not in PYTHON]
LINTERS = ("flake8", "pep257")
NOT_PASSED = {"failure", "error", "skipped"}
PATIENCE = 60.0  # seconds: a deadline, not an expectation
FIRST_LINES = {
    "basic_node": "Basic node initialised",
    "configured_node": "DefaultRobot is ready",
    "distance_driver": "Distance driver initialised",
    "robot_controller": "Robot controller initialised",
    "robust_node": "Robust node initialised",
    "sensor_processor": "Sensor processor initialised",
    "status_publisher": "Status of MyRobot01 every 1 s",
}

# A node that answers is spinning. A signal between its first line and its spin would interrupt rclpy itself.
ASK = """
import sys
import rclpy
from rcl_interfaces.srv import GetParameters

rclpy.init()
node = rclpy.create_node("asker")
client = node.create_client(GetParameters, f"/{sys.argv[1]}/get_parameters")
assert client.wait_for_service(timeout_sec=60.0)
future = client.call_async(GetParameters.Request(names=["use_sim_time"]))
rclpy.spin_until_future_complete(node, future, timeout_sec=60.0)
assert future.done()
node.destroy_node()
rclpy.try_shutdown()
"""
LOAD = """
import importlib, sys
from rclpy.type_support import check_for_type_support
for path in sys.argv[2:]:
    kind, name = path.split("/")
    check_for_type_support(getattr(importlib.import_module(f"{sys.argv[1]}.{kind}"), name))
"""


@pytest.fixture
def terminal(reference: Terminal, ros_domain: int) -> Terminal:
    """The sourced workspace, in the test's own domain."""
    return Terminal(reference.root, {**reference.variables, "ROS_DOMAIN_ID": str(ros_domain)})


@contextmanager
def node(terminal: Terminal, name: str, *arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Start a node of my_robot_package; yield its process and its first line of output."""
    with subprocess.Popen(
        [executable(terminal, name), *arguments],
        cwd=terminal.root,
        env=terminal.variables,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    ) as process:
        assert process.stdout is not None
        try:
            yield process, process.stdout.readline()
        finally:
            process.kill()


def executable(terminal: Terminal, name: str) -> Path:
    return terminal.root / "install/my_robot_package/lib/my_robot_package" / name


@pytest.fixture(scope="module")
def test_output(reference: Terminal) -> str:
    """The output of `colcon test`, and of the linters for message packages, which have no tests that call them."""
    output = reference.run("colcon", "test", "--packages-select", *PYTHON).stdout
    for package in MESSAGES:
        for linter in LINTERS:
            report = reference.root / "build" / package / f"{linter}.xunit.xml"
            output += reference.run(f"ament_{linter}", "--xunit-file", report, f"src/{package}").stdout
    return output


def test_colcon_builds_each_reference_package_without_a_warning(reference: Terminal) -> None:
    output = (reference.root / "log/build.txt").read_text()
    assert f"{len(PYTHON)} packages finished" in output
    assert "stderr" not in output


@pytest.mark.parametrize("package", PACKAGES)
def test_the_linters_and_the_tests_of_a_package_pass(reference: Terminal, test_output: str, package: str) -> None:
    reports = list((reference.root / "build" / package).glob("*.xml"))
    cases = [case for report in reports for case in ElementTree.parse(report).iter("testcase")]
    not_passed = [case.get("name") for case in cases if {child.tag for child in case} & NOT_PASSED]
    assert not_passed == [], test_output
    if package in MESSAGES:
        assert {report.name for report in reports} >= {f"{linter}.xunit.xml" for linter in LINTERS}, test_output
    else:
        test_names = {case.get("name", "").partition("[")[0] for case in cases}
        linters = {f"test_{linter}" for linter in LINTERS}
        assert linters <= test_names, test_output
        assert test_names - linters - {"test_copyright", "test_each_source_file_starts_with_its_licence"}, test_output


@pytest.mark.parametrize("package", MESSAGES)
def test_the_generated_types_of_an_interface_package_can_be_loaded(terminal: Terminal, package: str) -> None:
    folder = PACKAGES[package]
    names = [
        f"{path.parent.name}/{path.stem}" for kind in ("msg", "srv", "action") for path in folder.glob(f"{kind}/*")
    ]
    assert names
    process = terminal.run(sys.executable, "-c", LOAD, package, *names)
    assert process.returncode == 0, process.stdout


def stop(process: subprocess.Popen[str], number: signal.Signals) -> str:
    """Send a signal, and SIGTERM again if the node missed it; return the node's output.

    At SIGTERM, rclpy first wakes the executor and then shuts the context down. If the executor is faster, it finds the
    context still valid and waits for the next event: forever, in a node without timers that receives no messages.
    """
    for _ in range(3):
        process.send_signal(number)
        try:
            return process.communicate(timeout=20)[0]
        except subprocess.TimeoutExpired:
            assert number is signal.SIGTERM
    raise AssertionError(f"the node did not end after three times {number.name}")


@pytest.mark.parametrize("name", FIRST_LINES)
@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.nightly)])
def test_each_installed_executable_starts_and_ends_cleanly(
    terminal: Terminal, name: str, number: signal.Signals
) -> None:
    with node(terminal, name) as (process, first_line):
        assert FIRST_LINES[name] in first_line
        answer = terminal.run(sys.executable, "-c", ASK, name)
        assert answer.returncode == 0, answer.stdout
        output = stop(process, number)
    assert process.returncode == 0, output
    assert "Traceback" not in output


def test_a_node_uses_the_values_of_its_parameter_file(terminal: Terminal, tmp_path: Path) -> None:
    config = terminal.root / "install/my_robot_package/share/my_robot_package/config/robot_params.yaml"
    renamed = tmp_path / "renamed.yaml"
    renamed.write_text(config.read_text().replace("MyRobot01", "Wall-hugger"))
    with node(terminal, "status_publisher", "--ros-args", "--params-file", str(renamed)) as (_, first_line):
        assert "Status of Wall-hugger" in first_line


def test_every_launched_executable_exists(terminal: Terminal) -> None:
    launch = terminal.root / "install/my_robot_package/share/my_robot_package/launch/robot_system.launch.py"
    launched = [
        ast.literal_eval(keyword.value)
        for call in ast.walk(ast.parse(launch.read_text()))
        if isinstance(call, ast.Call)
        for keyword in call.keywords
        if keyword.arg == "executable"
    ]
    assert launched == ["robot_controller", "sensor_processor", "status_publisher"]
    for name in launched:
        assert os.access(executable(terminal, name), os.X_OK)


def test_two_robots_start_in_their_namespaces_and_end_together(
    reference: Terminal, ros_domain: int, tmp_path: Path
) -> None:
    workspace = Workspace(reference.root, environment.find(), tmp_path, domain=ros_domain)
    with LaunchHarness(
        workspace, "my_robot_bringup", "two_robots.launch.py", subscribes={"/fleet/status": String}
    ) as harness:
        names = [f"/{robot}/{node}" for robot in ("robot1", "robot2") for node in ("driver", "reporter")]
        launch_probe.expect_nodes(harness, names)
        launch_probe.expect_parameters(harness, "/robot2/driver", {"speed": 0.2, "turn_rate": 0.4})
        expected = {f"robot{number} drives at 0.20 m/s" for number in (1, 2)}
        assert harness.wait_for(
            lambda: {message.data for message in harness.messages("/fleet/status")} >= expected, PATIENCE
        )
        launch_probe.expect_clean_stop(harness)
