"""Sleeps are found in the source, in any spelling."""

from __future__ import annotations

import pytest

from autograder.checks.ch06_testing.support.sleeping import MAX_BYTES, sleeps

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
    assert sleeps(SLEEPY.encode()) == [5, 6, 9, 10, 11, 12]


@pytest.mark.parametrize("text", ["def (", "\0", "-" * 5000 + "1", "#" * (MAX_BYTES + 1)])
def test_a_file_that_is_not_python_has_no_sleeps(text: str) -> None:
    assert sleeps(text.encode()) == []
