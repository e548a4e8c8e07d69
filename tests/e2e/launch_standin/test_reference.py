"""The launch files of the course's package, built as a student builds it, and the one that the chapter prints."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder.ros import environment

Start = Callable[..., Any]
SOLUTIONS = Path(__file__).parents[3] / "solutions"


@pytest.fixture(scope="module")
def install(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `install` folder of a workspace with the course's packages."""
    workspace = tmp_path_factory.mktemp("reference")
    # fmt: off
    subprocess.run(
        ["colcon", "--log-base", workspace / "log", "build", "--base-paths", SOLUTIONS,
         "--build-base", workspace / "build", "--install-base", workspace / "install",
         "--packages-select", "my_robot_interfaces", "my_robot_package"],
        env={
            "PATH": f"{Path(sys.executable).parent}:/usr/local/bin:/usr/bin:/bin",
            "MAKEFLAGS": "-j3",
            **environment.find().variables(log_dir=workspace / "ros_log"),
        },
        check=True, capture_output=True, timeout=600,
    )
    # fmt: on
    return workspace / "install"


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_the_reference_runs_unmodified_with_its_parameters(start: Start, install: Path) -> None:
    launch = start("observed", "package:=my_robot_package", "file:=robot_system.launch.py", install=install)
    found = json.loads(launch.wait_for("found: (.*)")[1])
    assert set(found) == {"/robot_controller", "/status_publisher"}
    assert found["/status_publisher"]["robot_name"] == "MyRobot01"
    assert found["/status_publisher"]["status_period"] == 1.0
    assert launch.interrupt() == 0
    for name in ("robot_controller", "status_publisher"):
        assert re.search(rf"\[INFO\] \[{name}-\d+\]: process has finished cleanly", launch.text)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_the_chapters_launch_file_names_an_executable_that_no_package_has(start: Start, install: Path) -> None:
    launch = start("chapter", install=install)
    assert launch.finish() == 1
    libexec = install / "my_robot_package/lib/my_robot_package"
    assert (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
        f"executable 'sensor_processor' not found on the libexec directory '{libexec}' "
    ) in launch.text
