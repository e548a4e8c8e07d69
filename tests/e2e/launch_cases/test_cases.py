"""The stand-ins for launch behave like the real packages: the same launch descriptions give the same records.

`records.yaml` was written with the real packages by `runner.py`. If those are installed, this test compares them as
well.
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
# Cases in which the stand-ins print something else, with reasons.
DIFFERENCES: dict[str, dict[str, Any]] = yaml.safe_load((HERE / "differences.yaml").read_text())
STAND_IN = "standins" in str(launch.__file__)


@pytest.fixture(scope="module")
def records() -> dict[str, dict[str, Any]]:
    program = [sys.executable, "-m", "tests.e2e.launch_cases.runner"]
    with Domain() as domain:
        variables = {**os.environ, "ROS_DOMAIN_ID": str(domain.number)}
        done = subprocess.run(program, cwd=ROOT, env=variables, capture_output=True, text=True, check=True)
    found: dict[str, dict[str, Any]] = yaml.safe_load(done.stdout)
    return found


def test_each_case_has_a_record() -> None:
    assert list(cases()) == list(EXPECTED)
    assert set(DIFFERENCES) <= set(EXPECTED)


@pytest.mark.promise("Tests compare them with recordings of the real packages")
@pytest.mark.parametrize("name", EXPECTED)
def test_a_case_behaves_as_with_the_real_packages(name: str, records: dict[str, dict[str, Any]]) -> None:
    expected = dict(EXPECTED[name])
    if STAND_IN and name in DIFFERENCES:
        assert DIFFERENCES[name]["log"] != expected["log"]
        expected |= {part: said for part, said in DIFFERENCES[name].items() if part != "reason"}
    assert records[name] == expected
