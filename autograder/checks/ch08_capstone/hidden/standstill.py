"""Step 2: a robot that stands still during a turn continues the turn afterwards."""

from __future__ import annotations

import math
from collections.abc import Callable

from autograder.checking import expect
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.hidden.tracks import MIN_TURN_RATE
from autograder.checks.ch08_capstone.support.system import System, SystemMessages

OBSTACLE = Part(-10.0, 10.0, 0.4)
_TURNED = {-1: "turned right", 0: "did not turn", 1: "turned left"}


def expect_turn_kept(system: System, stand_still: Callable[[], object], situation: str) -> None:
    """Fail the check if a robot changes the direction of its turn while it stands still.

    When it continues, the other side has more room than before. Another check tests the direction itself.
    """
    system.publish_scans(OPEN)
    before = _direction(system.publish_scans(scan(OBSTACLE, beside(-1.0, 0.8))))
    stand_still()
    after = _direction(system.publish_scans(scan(OBSTACLE, beside(1.0, 0.5))))
    message = f"{situation}, it {_TURNED[after]}, though it {_TURNED[before]} before and the way was not clear yet."
    expect(after == before, message, fraction=0.75)


def beside(sign: float, distance: float) -> Part:
    """Return a part of a scan with a thing on the left (sign 1) or on the right (-1)."""
    return Part(90.0 * sign - 20.0, 90.0 * sign + 20.0, distance)


def _direction(messages: SystemMessages) -> int:
    """Return the direction in which the newest command turns: 1 is left, -1 right, 0 neither."""
    expect(bool(messages.commands), "No command came on cmd_vel.")
    rate = messages.commands[-1].message.angular.z
    return int(math.copysign(1, rate)) if abs(rate) > MIN_TURN_RATE else 0
