"""Each comparison accepts values within its tolerance, rejects a deviation of twice that, and states a reason."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import Twist
from hypothesis import given, settings
from hypothesis import strategies as st

from autograder.checks.ch00_welcome.visible import square
from autograder.checks.ch01_package_structure.support import robots
from autograder.checks.ch02_nodes.support import contract as nodes
from autograder.checks.ch02_nodes.support import robot as controller
from autograder.checks.ch03_interfaces.hidden import action
from autograder.checks.ch05_parameters.support import robot as configured
from autograder.checks.ch08_capstone.support import contract as capstone
from autograder.checks.ch08_capstone.support import expectations
from autograder.checks.ch09_assessment.support import contract as assessment
from autograder.checks.ch09_assessment.support import robot as heater
from autograder.course_paths import CHECKS
from autograder.suite.declaration import CheckFailed

NAMED = re.compile(r"^(?:[A-Z]+_)?(?:TOLERANCE|SLACK|EXACT|ROUNDED|FLOAT32) = .*$", re.MULTILINE)


@dataclass(frozen=True)
class Comparison:
    """How a chapter compares a number with the expected one."""

    near: Callable[[float, float], bool]
    tolerance: Callable[[float], float]  # for an expected number
    lowest: float
    highest: float


def _command(linear: float, angular: float = 0.0) -> Any:
    command = Twist()
    command.linear.x, command.angular.z = linear, angular
    return SimpleNamespace(message=command, seconds=0.0)


def _passes(check: Callable[..., None], *arguments: Any) -> bool:
    try:
        check(*arguments)
    except CheckFailed:
        return False
    return True


COMPARISONS = {
    "00 speed": Comparison(square._near, lambda _: square.TOLERANCE, -1.0, 1.0),
    "01 speed": Comparison(lambda x, w: robots._matches(_command(x), w, 0.0), lambda _: robots.TOLERANCE, -1.0, 1.0),
    "02 forward": Comparison(lambda x, w: controller._matches((x, 0.0), (w, 0.0)), lambda _: nodes.TOLERANCE, 0.0, 1.0),
    "02 turn": Comparison(lambda x, w: controller._matches((0.0, x), (0.0, w)), lambda _: nodes.TOLERANCE, 0.0, 1.0),
    "03 speed": Comparison(
        lambda x, w: action.drives_straight(_command(x).message, w), lambda _: action.SLACK, 0.0, 0.5
    ),
    "05 speed": Comparison(
        lambda x, w: _passes(configured.expect_speed, x, w, ""), lambda _: configured.TOLERANCE, 0.0, 1.0
    ),
    "05 rate": Comparison(
        lambda x, w: _passes(configured.expect_rate, x, w, ""), lambda w: configured.RATE_TOLERANCE * w, 1.0, 50.0
    ),
    "08 fastest": Comparison(
        lambda x, w: (
            _passes(expectations.expect_driving, [_command(x)], "", w) if x > w else expectations._is_near(x, w)
        ),
        lambda _: capstone.TOLERANCE,
        0.05,
        0.5,
    ),
    "08 still": Comparison(
        lambda x, w: _passes(expectations.expect_still, [_command(x - w)], ""), lambda _: capstone.TOLERANCE, 0.0, 1.0
    ),
    "09 temperature": Comparison(heater.near, lambda _: assessment.TOLERANCE, -40.0, 100.0),
}


@pytest.mark.parametrize("comparison", COMPARISONS.values(), ids=COMPARISONS)
@settings(max_examples=25, deadline=None)
@given(share=st.floats(0.0, 1.0), far=st.floats(2.0, 1000.0), up=st.booleans())
def test_a_value_within_the_tolerance_is_right_and_one_twice_as_far_is_wrong(
    comparison: Comparison, share: float, far: float, up: bool
) -> None:
    expected = comparison.lowest + share * (comparison.highest - comparison.lowest)
    step = comparison.tolerance(expected) * (1.0 if up else -1.0)
    for within in (0.0, share * 0.999, 0.999):  # at the very limit, rounding decides
        assert comparison.near(expected + within * step, expected)
    for beyond in (2.0, far):
        assert not comparison.near(expected + beyond * step, expected)
    assert not comparison.near(float("nan"), expected)


def test_each_tolerance_has_its_reason() -> None:
    tolerances = [
        (path.parts[-3], line)
        for path in sorted(CHECKS.glob("ch*/*/*.py"))
        if path.parent.name in ("support", "hidden", "visible")
        for line in NAMED.findall(path.read_text())
    ]
    assert len(tolerances) >= 10
    assert not [entry for entry in tolerances if not re.search(r"  # .*[:,] .+|  # the ", entry[1])]
