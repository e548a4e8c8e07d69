"""Packages created by `ros2 pkg create` build, pass their tests and linters, run and launch."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import pytest

from autograder.ros import activate
from tests.e2e.ros2_records.runner import is_stand_in

DESCRIPTION = 'Says "hello" & it\'s <polite>'

ROS2 = [sys.executable, "-m", "autograder.ros.ros2"]
PATIENCE = 120.0  # seconds: a deadline, not an expectation

# The real ros2 has other options and does not quote texts in setup.py; its output is recorded in ros2_records.
pytestmark = pytest.mark.skipif(not is_stand_in(), reason="tests the stand-in for ros2, but the real one is installed")

LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('who', default_value='world', description='Whom to greet'),
        LogInfo(msg=['greeting ', LaunchConfiguration('who')]),
        Node(package='py_pkg', executable='hello', output='screen'),
    ])
"""
# Ends only on SIGINT, with exit code 7. It waits with sigwait, because a signal handler that sets a threading.Event can
# deadlock if the same thread has just begun to wait for it.
STUBBORN = """import signal
import sys


def main():
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    print('arguments', *sys.argv[1:], flush=True)
    signal.sigwait([signal.SIGINT])
    sys.exit(7)
"""


@dataclass
class Workspace:
    """A colcon workspace and the environment in which it is sourced."""

    folder: Path
    env: dict[str, str]

    def run(self, *command: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            command, cwd=cwd or self.folder, env=self.env, capture_output=True, text=True, timeout=2 * PATIENCE
        )

    def ros2(self, *arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        return self.run(*ROS2, *arguments, cwd=cwd)

    def colcon(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return self.run(sys.executable, "-m", "colcon", *arguments)


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    """Create two packages, add a launch file and a second executable to one of them, and build both."""
    folder = tmp_path_factory.mktemp("created")
    source = folder / "src"
    source.mkdir()
    install = folder / "install"
    env = {**os.environ, **activate().variables(overlays=(install,))}
    env["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{env['PATH']}"
    env["PYTHONPATH"] = str(install / f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages")
    env["LD_LIBRARY_PATH"] = os.pathsep.join([str(install / "lib"), env.get("LD_LIBRARY_PATH", "")])
    created = Workspace(folder, env)
    maintainer = ("--license", "Apache-2.0", "--maintainer-name", "Ada O'Neil", "--maintainer-email", "ada@example.com")
    python = ("--build-type", "ament_python", "--node-name", "hello", "--dependencies", "rclpy", "std_msgs")
    description = ("--description", DESCRIPTION)
    assert created.ros2("pkg", "create", "py_pkg", *maintainer, *python, *description, cwd=source).returncode == 0
    assert created.ros2("pkg", "create", "cmake_pkg", *maintainer, cwd=source).returncode == 0
    package = source / "py_pkg"
    (package / "launch").mkdir()
    (package / "launch" / "hello.launch.py").write_text(LAUNCH)
    (package / "py_pkg" / "stubborn.py").write_text(STUBBORN)
    setup = (package / "setup.py").read_text()
    setup = setup.replace("['package.xml']),", "['package.xml', 'launch/hello.launch.py']),")
    setup = setup.replace("hello:main',", "hello:main',\n            'stubborn = py_pkg.stubborn:main',")
    (package / "setup.py").write_text(setup)
    built = created.colcon("build", "--merge-install")
    assert built.returncode == 0, built.stdout + built.stderr
    return created


def test_created_packages_pass_colcon_test_and_the_linters(workspace: Workspace) -> None:
    tested = workspace.colcon("test", "--merge-install")
    assert tested.returncode == 0, tested.stdout + tested.stderr
    result = workspace.colcon("test-result", "--all", "--verbose")
    assert result.returncode == 0, result.stdout
    # flake8 and pep257 ran; the copyright check is skipped until the files have headers.
    assert "Summary: 3 tests, 0 errors, 0 failures, 1 skipped" in result.stdout


def test_the_copyright_check_passes_once_all_files_have_headers(workspace: Workspace) -> None:
    package = workspace.folder / "src" / "py_pkg"
    header = "# Copyright 2026 Ada O'Neil\n# SPDX-License-Identifier: Apache-2.0\n\n"
    command = (sys.executable, "-m", "ament_copyright", str(package))
    before = workspace.run(*command)
    assert before.returncode == 1
    assert "hello.py: could not find copyright notice" in before.stderr
    for path in [*package.glob("py_pkg/*.py"), *package.glob("test/*.py"), *package.glob("launch/*.py")]:
        if path.read_text():
            path.write_text(header + path.read_text())
    after = workspace.run(*command)
    assert (after.returncode, after.stderr) == (0, "")


def test_the_verbs_of_ros2_pkg_find_a_created_package(workspace: Workspace) -> None:
    assert workspace.ros2("pkg", "executables", "py_pkg").stdout == "py_pkg hello\npy_pkg stubborn\n"
    install = workspace.folder / "install"
    assert workspace.ros2("pkg", "prefix", "py_pkg").stdout == f"{install}\n"
    assert workspace.ros2("pkg", "prefix", "--share", "cmake_pkg").stdout == f"{install}/share/cmake_pkg\n"
    assert {"py_pkg", "cmake_pkg", "rclpy"} <= set(workspace.ros2("pkg", "list").stdout.split())
    manifest = ElementTree.parse(install / "share" / "py_pkg" / "package.xml")
    assert (manifest.findtext("description"), manifest.findtext("license")) == (DESCRIPTION, "Apache-2.0")
    missing = workspace.ros2("pkg", "prefix", "nothing")
    assert (missing.returncode, missing.stderr) == (1, "Package not found\n")


def test_ros2_run_starts_an_executable(workspace: Workspace) -> None:
    assert workspace.ros2("run", "py_pkg", "hello").stdout == "Hi from py_pkg.\n"
    assert workspace.ros2("run", "--prefix", "echo would run", "py_pkg", "hello", "-x").stdout.startswith("would run /")


@pytest.mark.promise("| `Package 'my_robot_package' not found` in a terminal |")
@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("nothing", "hello"), "Package 'nothing' not found\n"),
        (("py_pkg", "nothing"), "No executable found\n"),
    ],
)
def test_ros2_run_names_a_missing_package_or_executable(
    workspace: Workspace, arguments: tuple[str, str], error: str
) -> None:
    answer = workspace.ros2("run", *arguments)
    assert (answer.returncode, answer.stderr) == (1, error)


def test_ros2_run_passes_on_arguments_signals_and_the_exit_code(workspace: Workspace) -> None:
    command = [*ROS2, "run", "py_pkg", "stubborn", "--ros-args", "-p", "speed:=1.0"]
    with subprocess.Popen(
        command, env=workspace.env, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "arguments --ros-args -p speed:=1.0\n"
        # Like Ctrl-C in a terminal: the whole process group gets the signal, and the executable decides when to end.
        os.killpg(process.pid, signal.SIGINT)
        out, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 7
    assert out == "[ros2run]: Process exited with failure 7\n"


def test_terminating_ros2_run_ends_its_executable(workspace: Workspace) -> None:
    command = [*ROS2, "run", "py_pkg", "stubborn"]
    with subprocess.Popen(command, env=workspace.env, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "arguments\n"
        process.terminate()
        # The pipe closes only after the executable, which also holds it, has ended.
        out, _ = process.communicate(timeout=PATIENCE)
    assert out == "[ros2run]: Terminated\n"


def test_ros2_launch_runs_a_file_of_a_package_with_arguments(workspace: Workspace) -> None:
    answer = workspace.ros2("launch", "py_pkg", "hello.launch.py", "who:=everyone")
    assert answer.returncode == 0, answer.stdout + answer.stderr
    printed = answer.stdout + answer.stderr
    assert "greeting everyone" in printed
    assert "Hi from py_pkg." in printed


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ending_ros2_launch_ends_its_nodes(workspace: Workspace, tmp_path: Path, number: int) -> None:
    file = tmp_path / "stubborn.launch.py"
    file.write_text(LAUNCH.replace("executable='hello'", "executable='stubborn'"))
    # On a busy machine, a node may need longer than the 5 s after which launch sends SIGTERM.
    command = [*ROS2, "launch", str(file), f"sigterm_timeout:={PATIENCE}"]
    with subprocess.Popen(
        command, env=workspace.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        assert process.stdout is not None
        assert any("arguments" in line for line in process.stdout)
        process.send_signal(number)
        # The pipe closes only after the node, which also holds it, has ended.
        rest, _ = process.communicate(timeout=PATIENCE)
    assert "process has died" in rest
    assert "exit code 7" in rest


def test_ros2_launch_shows_arguments_and_the_description(workspace: Workspace) -> None:
    path = workspace.folder / "src/py_pkg/launch/hello.launch.py"
    listed = workspace.ros2("launch", str(path), "--show-args")
    assert listed.stdout == (
        "Arguments (pass arguments as '<name>:=<value>'):\n\n"
        "    'who':\n        Whom to greet\n        (default: 'world')\n"
    )
    described = workspace.ros2("launch", "py_pkg", "hello.launch.py", "--print-description")
    assert described.returncode == 0
    assert "LogInfo(" in described.stdout
    assert "Hi from" not in described.stdout


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("nothing", "x.launch.py"), "Package 'nothing' not found"),
        (("py_pkg", "x.launch.py"), "file 'x.launch.py' was not found in the share directory of package 'py_pkg'"),
        (
            ("py_pkg", "hello.launch.py", "who=me"),
            "malformed launch argument 'who=me', expected format '<name>:=<value>'",
        ),
        (("py_pkg",), "launch_file_name is required"),
        (("./gone.launch.py",), "File './gone.launch.py' not found"),
    ],
)
def test_ros2_launch_reports_errors(workspace: Workspace, arguments: tuple[str, ...], error: str) -> None:
    answer = workspace.ros2("launch", *arguments)
    assert answer.returncode == 1
    assert answer.stderr.startswith(error)
