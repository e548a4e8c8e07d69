"""Sleeps are found in the source, in any spelling."""

from __future__ import annotations

import pytest

from autograder.checks.ch06_testing.support.sleeping import MAX_BYTES, sleeps
from autograder.suite import CheckFailed

SLEEPY = """import time
from time import sleep, sleep as nap
import rclpy

time.sleep(1)
sleep(0.1)
# time.sleep(2)
text = 'time.sleep(3)'
node.get_clock().sleep_for(1)
node.get_clock().sleep_until(then)
nap(1)
threading.Event().wait(1)
stopped.wait(1)
rclpy.spin_once(node, timeout_sec=0.1)
"""


def test_only_the_lines_of_sleeps_are_found() -> None:
    assert sleeps(SLEEPY.encode(), "test_guard.py") == [5, 6, 9, 10, 11, 12]


@pytest.mark.parametrize("text", ["def (", "\0", "-" * 100_000 + "1"])
def test_a_file_that_cannot_be_parsed_is_refused(text: str) -> None:
    with pytest.raises(CheckFailed, match=r"test_guard.py cannot be parsed as Python"):
        sleeps(text.encode(), "test_guard.py")


def test_a_file_that_is_too_large_to_search_is_refused() -> None:
    with pytest.raises(CheckFailed, match=r"test_guard.py is larger than 256 KiB"):
        sleeps(b"import time\ntime.sleep(1)\n" + b"\n" * MAX_BYTES, "test_guard.py")
