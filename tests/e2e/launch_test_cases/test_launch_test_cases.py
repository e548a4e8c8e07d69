"""The stand-in for launch_testing runs launch tests as the real package does, by pytest.

`runner.py` wrote `records.yaml` with the real packages. If these are installed, the tests compare them, too.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import pytest
import yaml

from autograder.course_paths import ROOT
from tests.e2e.launch_test_cases.runner import CALLS, RECORDS

EXPECTED: list[dict[str, Any]] = yaml.safe_load(RECORDS.read_text())


@pytest.fixture(scope="module")
def records() -> list[dict[str, Any]]:
    program = [sys.executable, "-m", "tests.e2e.launch_test_cases.runner"]
    process = subprocess.run(program, cwd=ROOT, env={**os.environ}, stdout=subprocess.PIPE, text=True, check=True)
    recorded: list[dict[str, Any]] = yaml.safe_load(process.stdout)
    return recorded


def test_each_call_has_a_record() -> None:
    assert [record["call"] for record in EXPECTED] == list(CALLS)


@pytest.mark.promise("Tests compare them with recordings of the real packages")
@pytest.mark.parametrize("number", range(len(CALLS)), ids=CALLS)
def test_a_launch_test_behaves_as_with_the_real_package(number: int, records: list[dict[str, Any]]) -> None:
    assert records[number] == EXPECTED[number]
