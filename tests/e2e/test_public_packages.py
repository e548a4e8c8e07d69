"""Unmodified public ROS packages build here, their tests run, and their programs communicate.

Two variables are the paths of clones with the branch jazzy: ROS2_EXAMPLES_SOURCE of github.com/ros2/examples, and
ROS2_DEMOS_SOURCE of github.com/ros2/demos. `make public-packages` clones them.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

SOURCES = {
    "ROS2_EXAMPLES_SOURCE": ("rclpy",),
    "ROS2_DEMOS_SOURCE": ("demo_nodes_py", "action_tutorials/action_tutorials_py"),
}
PATIENCE = 600.0
# A first program, its output when it is ready, a second program, and the expected output of that one.
PAIRS = (
    ("examples_rclpy_minimal_service service", None, "examples_rclpy_minimal_client client", "for 41 + 1 = 42"),
    ("examples_rclpy_minimal_service service", None, "examples_rclpy_minimal_client client_async", "for 41 + 1 = 42"),
    ("demo_nodes_py add_two_ints_server", None, "demo_nodes_py add_two_ints_client", "Result of add_two_ints: 5"),
    (
        "examples_rclpy_minimal_action_server server",
        None,
        "examples_rclpy_minimal_action_client client",
        "Goal succeeded! Result: array('i', [0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55])",
    ),
    (
        "action_tutorials_py fibonacci_action_server",
        None,
        "action_tutorials_py fibonacci_action_client",
        "Result: array('i', [0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55])",
    ),
    ("demo_nodes_py talker", "Publishing", "demo_nodes_py listener", "I heard: [Hello World"),
    (
        "examples_rclpy_minimal_publisher publisher_member_function",
        "Publishing",
        "examples_rclpy_minimal_subscriber subscriber_member_function",
        'I heard: "Hello World',
    ),
)

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(2 * PATIENCE),
    pytest.mark.skipif(
        not all(os.environ.get(name) for name in SOURCES), reason=f"{' and '.join(SOURCES)} are not set"
    ),
]


def ros(workspace: Path, command: str) -> list[str]:
    """Return the arguments that run a shell command with ROS, and with the workspace sourced if it is built."""
    source = "test ! -f install/setup.bash || source install/setup.bash;"
    return [sys.executable, "-m", "autograder", "ros", "bash", "-c", f"cd '{workspace}'; {source} exec {command}"]


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the packages of both repositories."""
    folder = tmp_path_factory.mktemp("public")
    for name, packages in SOURCES.items():
        for package in packages:
            link = folder / "src" / package
            link.parent.mkdir(parents=True, exist_ok=True)
            link.symlink_to(Path(os.environ[name]).resolve() / package)
    built = subprocess.run(ros(folder, "colcon build"), capture_output=True, text=True, timeout=PATIENCE)
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


@pytest.mark.promise(
    "`make public-packages` builds the Python packages of ros2/examples", "It runs their tests with `colcon test`"
)
def test_colcon_runs_the_tests_of_each_package(workspace: Path) -> None:
    command = "colcon test --return-code-on-test-failure"
    tested = subprocess.run(ros(workspace, command), capture_output=True, text=True, timeout=PATIENCE)
    assert tested.returncode == 0, tested.stdout + tested.stderr
    result = subprocess.run(
        ros(workspace, "colcon test-result --all"), capture_output=True, text=True, timeout=PATIENCE
    )
    counts = dict(re.findall(r"build/(\w+)/pytest.xml: (\d+) tests, 0 errors, 0 failures", result.stdout))
    packages = {path.name for path in (workspace / "build").iterdir() if path.is_dir()}
    assert set(counts) == packages, result.stdout
    assert all(int(count) >= 3 for count in counts.values()), counts


@pytest.mark.promise("lets their servers and clients, publishers and subscribers communicate")
@pytest.mark.parametrize(("first", "ready", "second", "expected"), PAIRS)
def test_two_public_programs_exchange_messages(
    workspace: Path, ros_domain: int, first: str, ready: str | None, second: str, expected: str
) -> None:
    environment = {**os.environ, "ROS_DOMAIN_ID": str(ros_domain), "PYTHONUNBUFFERED": "1"}
    pipes: dict[str, object] = {
        "stdout": subprocess.PIPE,
        "stderr": subprocess.STDOUT,
        "text": True,
        "env": environment,
    }
    pipes["start_new_session"] = True  # so that SIGINT reaches `ros2 run` and its program, as from a terminal
    with (
        subprocess.Popen(ros(workspace, f"ros2 run {first}"), **pipes) as server,  # type: ignore[call-overload]
        subprocess.Popen(ros(workspace, f"ros2 run {second}"), **pipes) as client,  # type: ignore[call-overload]
    ):
        try:
            if ready is not None:
                assert any(ready in line for line in server.stdout)
            assert any(expected in line for line in client.stdout)
        finally:
            for process in (client, server):
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGINT)
                process.communicate(timeout=PATIENCE)
