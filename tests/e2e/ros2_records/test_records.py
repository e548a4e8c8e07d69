"""The stand-in for `ros2` has the same output and exit status as the real command, for the same commands and nodes.

`runner.py` wrote `records.yaml` with the real ros2cli. If that is installed, the tests compare it, too.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import pytest
import yaml

from autograder.course_paths import ROOT
from autograder.ros.domains import Domain
from tests.e2e.ros2_records.runner import HERE, RECORDS, is_stand_in

EXPECTED: dict[str, list[dict[str, Any]]] = yaml.safe_load(RECORDS.read_text())
# Commands for which the stand-in differs, with reasons.
DIFFERENCES: dict[str, dict[str, Any]] = {
    difference.pop("command"): difference for difference in yaml.safe_load((HERE / "differences.yaml").read_text())
}
CALLS = [(group, number) for group, calls in EXPECTED.items() for number in range(len(calls))]
NOTHING = {"output": "", "error": "", "made": []}


@pytest.fixture(scope="module")
def records() -> dict[str, list[dict[str, Any]]]:
    program = [sys.executable, "-m", "tests.e2e.ros2_records.runner"]
    with Domain() as domain:
        variables = {**os.environ, "ROS_DOMAIN_ID": str(domain.number)}
        process = subprocess.run(program, cwd=ROOT, env=variables, capture_output=True, text=True, check=False)
    if process.returncode:
        # Pytest's summary shows the first line of this message.
        pytest.fail(f"the runner failed: {(process.stderr.splitlines() or ['no output'])[-1]}\n{process.stderr}")
    recorded: dict[str, list[dict[str, Any]]] = yaml.safe_load(process.stdout)
    return recorded


@pytest.mark.promise("Differences are listed, with reasons,")
def test_each_listed_difference_exists_and_has_a_reason() -> None:
    calls = {call["command"]: {**NOTHING, **call} for calls in EXPECTED.values() for call in calls}
    for command, difference in DIFFERENCES.items():
        assert difference["reason"]
        assert any(difference[name] != calls[command][name] for name in difference if name != "reason")


@pytest.mark.promise("Tests compare them with recordings of the real packages")
@pytest.mark.parametrize(
    ("group", "number"), CALLS, ids=[f"{group}: {EXPECTED[group][number]['command']}" for group, number in CALLS]
)
def test_a_command_behaves_like_the_real_one(group: str, number: int, records: dict[str, list[dict[str, Any]]]) -> None:
    expected = {**NOTHING, **EXPECTED[group][number]}
    record = {**NOTHING, **records[group][number]}
    if is_stand_in():
        expected |= DIFFERENCES.get(expected["command"], {})
        expected.pop("reason", None)
    elif "or" in expected and record["status"] == expected["or"]["status"]:
        expected |= expected["or"]
    assert record == expected
