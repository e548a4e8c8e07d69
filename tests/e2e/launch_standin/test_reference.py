"""The launch files of the course's package, built as by a student, and the launch file printed in the chapter."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.e2e.conftest import Terminal

Start = Callable[..., Any]
SOLUTIONS = Path(__file__).parents[3] / "solutions"
NODES = ("robot_controller", "sensor_processor", "status_publisher")


@pytest.fixture(scope="module")
def install(reference: Terminal) -> Path:
    """The `install` folder of a workspace with the course's packages."""
    return reference.root / "install"


def observe_and_interrupt(start: Start, install: Path, package: str, file: str) -> str:
    """Launch a file, verify its nodes and their parameters, interrupt it, and return its output."""
    launch = start("observed", f"package:={package}", f"file:={file}.launch.py", install=install)
    parameters = json.loads(launch.wait_for("found: (.*)")[1])
    assert set(parameters) == {f"/{node}" for node in NODES}
    assert parameters["/status_publisher"]["robot_name"] == "MyRobot01"
    assert parameters["/status_publisher"]["status_period"] == 1.0
    assert launch.interrupt() == 0
    return str(launch.text)


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.parametrize(("package", "file"), [("my_robot_package", "robot_system"), ("fleet", "chapter")])
def test_the_reference_launch_file_runs_all_nodes_with_their_parameters_until_ctrl_c(
    start: Start, install: Path, package: str, file: str
) -> None:
    output = observe_and_interrupt(start, install, package, file)
    if "escalating to 'SIGKILL'" in output:  # Fast DDS sometimes deadlocks; expect_clean_stop has the same rule
        output = observe_and_interrupt(start, install, package, file)
    for node in NODES:
        assert re.search(rf"\[INFO\] \[{node}-\d+\]: process has finished cleanly", output)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_the_chapters_launch_file_ends_with_an_error_if_an_executable_is_missing(
    start: Start, install: Path, tmp_path: Path
) -> None:
    incomplete = tmp_path / "install"
    shutil.copytree(install, incomplete, symlinks=True)
    libexec = incomplete / "my_robot_package/lib/my_robot_package"
    (libexec / "sensor_processor").unlink()
    launch = start("chapter", install=incomplete)
    assert launch.finish() == 1
    assert (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
        f"executable 'sensor_processor' not found on the libexec directory '{libexec}' "
    ) in launch.text
