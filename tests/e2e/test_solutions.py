"""The reference packages build with colcon, pass their own tests, and their nodes start and end as they should."""

from __future__ import annotations

import ast
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import pytest

from autograder.layout import SOLUTIONS
from autograder.ros import environment

PACKAGES = ("my_robot_interfaces", "my_robot_package", "motor_guard_interfaces", "motor_guard")
FIRST_WORDS = {
    "basic_node": "Basic node initialised",
    "configured_node": "DefaultRobot is ready",
    "distance_driver": "Distance driver initialised",
    "robot_controller": "Robot controller initialised",
    "robust_node": "Robust node initialised",
    "sensor_processor": "Sensor processor initialised",
    "status_publisher": "Status of MyRobot01 every 1 s",
}

# A node that answers is spinning. A signal between its first words and its spin would hit rclpy itself.
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


@dataclass(frozen=True)
class Workspace:
    """A colcon workspace with the reference, built."""

    root: Path
    variables: dict[str, str]

    @property
    def executables(self) -> Path:
        return self.root / "install/my_robot_package/lib/my_robot_package"

    def run(self, *command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            command, cwd=self.root, env=self.variables, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )

    @contextmanager
    def node(self, name: str, *arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
        """Start a node and give it with its first line of output."""
        with subprocess.Popen(
            [self.executables / name, *arguments],
            cwd=self.root,
            env=self.variables,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        ) as process:
            assert process.stdout is not None
            try:
                yield process, process.stdout.readline()
            finally:
                process.kill()


@pytest.fixture(scope="session")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    root = tmp_path_factory.mktemp("reference")
    for package in PACKAGES:
        shutil.copytree(SOLUTIONS / package, root / "src" / package)
    ros = environment.find()
    variables = {
        **os.environ,
        **ros.variables(domain=1 + os.getpid() % 100, log_dir=root / "log/ros"),
        "MAKEFLAGS": "-j3",
    }
    variables["PATH"] = f"{ros.prefixes[0] / 'bin'}{os.pathsep}{variables['PATH']}"
    built = Workspace(root, variables)
    result = built.run("colcon", "build")
    assert result.returncode == 0, result.stdout
    sourced = built.run("bash", "-c", ". install/setup.bash && exec env -0").stdout
    return Workspace(root, dict(entry.split("=", 1) for entry in sourced.split("\0") if "=" in entry))


def test_colcon_test_runs_the_linters_and_the_unit_tests_and_all_pass(workspace: Workspace) -> None:
    ran = workspace.run("colcon", "test", "--packages-select", *PACKAGES, "--event-handlers", "console_direct+")
    result = workspace.run("colcon", "test-result", "--all", "--verbose")
    assert result.returncode == 0, ran.stdout + result.stdout
    report = ElementTree.parse(workspace.root / "build/my_robot_package/pytest.xml")
    passed = {case.get("name", "") for case in report.iter("testcase") if len(case) == 0}
    assert {"test_flake8", "test_pep257"} <= passed
    assert len(passed) > 30


@pytest.mark.parametrize("name", FIRST_WORDS)
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_each_installed_executable_starts_and_ends_cleanly(
    workspace: Workspace, name: str, how: signal.Signals
) -> None:
    with workspace.node(name) as (process, first):
        assert FIRST_WORDS[name] in first
        asked = workspace.run(sys.executable, "-c", ASK, name)
        assert asked.returncode == 0, asked.stdout
        process.send_signal(how)
        rest, _ = process.communicate()
    assert process.returncode == 0, rest
    assert "Traceback" not in rest


def test_the_configuration_reaches_its_node(workspace: Workspace) -> None:
    config = workspace.root / "install/my_robot_package/share/my_robot_package/config/robot_params.yaml"
    renamed = workspace.root / "renamed.yaml"
    renamed.write_text(config.read_text().replace("MyRobot01", "Wall-hugger"))
    with workspace.node("status_publisher", "--ros-args", "--params-file", str(renamed)) as (_, first):
        assert "Status of Wall-hugger" in first


def test_every_launched_executable_exists(workspace: Workspace) -> None:
    launch = workspace.root / "install/my_robot_package/share/my_robot_package/launch/robot_system.launch.py"
    launched = [
        ast.literal_eval(keyword.value)
        for node in ast.walk(ast.parse(launch.read_text()))
        if isinstance(node, ast.Call)
        for keyword in node.keywords
        if keyword.arg == "executable"
    ]
    assert launched == ["robot_controller", "sensor_processor", "status_publisher"]
    for name in launched:
        assert os.access(workspace.executables / name, os.X_OK)
