"""my_robot_bringup, the launch chapter's package: its linters and tests pass, and two robots come up and go."""

from __future__ import annotations

import os
import shutil
import subprocess
from xml.etree import ElementTree

import pytest
from std_msgs.msg import String

from autograder.lab import Workspace
from autograder.lab.launching import LaunchLab
from autograder.layout import SOLUTIONS
from autograder.probes import launching
from autograder.ros import environment

PACKAGE = "my_robot_bringup"
PATIENCE = 60.0  # seconds: a deadline, not an expectation


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    """A workspace in which the package was built and tested."""
    root = tmp_path_factory.mktemp("bringup")
    shutil.copytree(SOLUTIONS / PACKAGE, root / "src" / PACKAGE)
    (root / "scratch").mkdir()
    ros = environment.find()
    variables = {**os.environ, **ros.variables(log_dir=root / "log/ros"), "PATH": environment.path_with_scripts()}
    for command in (["colcon", "build"], ["colcon", "test", "--return-code-on-test-failure"]):
        done = subprocess.run(command, cwd=root, env=variables, text=True, capture_output=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return Workspace(root, ros, root / "scratch", domain=1 + os.getpid() % 100)


def test_its_linters_and_its_tests_pass(workspace: Workspace) -> None:
    report = ElementTree.parse(workspace.root / "build" / PACKAGE / "pytest.xml")
    passed = {case.get("name", "").partition("[")[0] for case in report.iter("testcase") if len(case) == 0}
    assert {"test_flake8", "test_pep257", "test_each_launched_executable_is_installed"} < passed


def test_two_robots_come_up_in_their_namespaces_and_end_together(workspace: Workspace) -> None:
    with LaunchLab(workspace, PACKAGE, "two_robots.launch.py", listens={"/fleet/status": String}) as lab:
        names = [f"/{robot}/{node}" for robot in ("robot1", "robot2") for node in ("driver", "reporter")]
        launching.expect_nodes(lab, names)
        launching.expect_parameters(lab, "/robot2/driver", {"speed": 0.2, "turn_rate": 0.4})
        wanted = {f"robot{number} drives at 0.20 m/s" for number in (1, 2)}
        assert lab.wait_for(lambda: {message.data for message in lab.messages("/fleet/status")} >= wanted, PATIENCE)
        launching.expect_clean_stop(lab)
