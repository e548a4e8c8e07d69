"""The stand-ins for launch behave like the real packages: the same launch descriptions give the same records.

`runner.py` wrote `records.yaml` with the real packages. If these are installed, the tests compare them, too.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import launch
import pytest
import yaml

from autograder.course_paths import ROOT
from autograder.ros.domains import Domain
from tests.e2e.launch_cases.runner import HERE, RECORDS, cases

EXPECTED: dict[str, dict[str, Any]] = yaml.safe_load(RECORDS.read_text())
# Cases in which the output of the stand-ins differs, with reasons.
DIFFERENCES: dict[str, dict[str, Any]] = yaml.safe_load((HERE / "differences.yaml").read_text())
STAND_IN = "standins" in str(launch.__file__)


@pytest.fixture(scope="module")
def records() -> dict[str, dict[str, Any]]:
    program = [sys.executable, "-m", "tests.e2e.launch_cases.runner"]
    with Domain() as domain:
        variables = {**os.environ, "ROS_DOMAIN_ID": str(domain.number)}
        process = subprocess.run(program, cwd=ROOT, env=variables, capture_output=True, text=True, check=True)
    records: dict[str, dict[str, Any]] = yaml.safe_load(process.stdout)
    return records


def test_each_case_has_a_record() -> None:
    assert list(cases()) == list(EXPECTED)
    assert set(DIFFERENCES) <= set(EXPECTED)


@pytest.mark.promise("Tests compare them with recordings of the real packages")
@pytest.mark.parametrize("name", EXPECTED)
def test_a_case_behaves_as_with_the_real_packages(name: str, records: dict[str, dict[str, Any]]) -> None:
    expected = dict(EXPECTED[name])
    if STAND_IN and name in DIFFERENCES:
        assert DIFFERENCES[name]["log"] != expected["log"]
        expected |= {part: text for part, text in DIFFERENCES[name].items() if part != "reason"}
    assert records[name] == expected
