"""`ros2 lifecycle` prints for real nodes what it prints on a real Jazzy."""

from __future__ import annotations

import itertools
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
import yaml

from tests.e2e.ros2_records.runner import is_stand_in

NODE = Path(__file__).parent / "launch_cases" / "prefix" / "lib" / "talk" / "live"
RECORDS = Path(__file__).with_name("ros2_lifecycle.yaml")

# The real one has other options, and writes what it is given into setup.py as it is; its records are in ros2_records.
pytestmark = pytest.mark.skipif(not is_stand_in(), reason="it is about the stand-in for ros2, and the real one is here")


@pytest.fixture
def nodes(ros_domain: int) -> Iterator[None]:
    """Two nodes with a life cycle; the transition `activate` of `/live` fails."""
    programs = [
        subprocess.Popen([sys.executable, NODE, "--ros-args", "-p", "heard:=false", *arguments])
        for arguments in (("-r", "__ns:=/left"), ("-p", "activate:=FAILURE"))
    ]
    yield
    for program in programs:
        program.kill()  # how they end is not asked here, and rclpy can miss a SIGTERM
    for program in programs:
        program.wait()


def lifecycle(*arguments: str, spin_time: str = "3") -> tuple[int, str]:
    program = [sys.executable, "-m", "autograder.ros.ros2", "lifecycle", *arguments, "--spin-time", spin_time]
    done = subprocess.run(program, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return done.returncode, done.stdout


def run(record: dict[str, object]) -> tuple[int, str]:
    """Run the command of a record; one that is about a node waits for it as long as a busy machine takes."""
    command = str(record["command"])
    return lifecycle(*command.split(), spin_time="60" if "live" in command else "3")


@pytest.mark.usefixtures("nodes")
def test_each_lifecycle_verb_prints_what_it_prints_on_jazzy() -> None:
    for name in ("live", "left/live"):
        assert lifecycle("get", name, spin_time="60") == (0, "unconfigured [1]\n")  # it is up
    records = yaml.safe_load(RECORDS.read_text())
    for _, group in itertools.groupby(records, lambda record: str(record["command"]).startswith("set ")):
        together = list(group)  # questions change nothing, so they run side by side
        with ThreadPoolExecutor(1 if together[0]["command"].startswith("set ") else 4) as pool:
            found = list(pool.map(run, together))
        assert found == [(record["status"], record["output"]) for record in together]
