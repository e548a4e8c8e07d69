"""Step 2: a robot that stands still for a while keeps the turn that it has begun."""

from __future__ import annotations

import math
from collections.abc import Callable

from autograder.checking import expect
from autograder.checks.ch02_nodes.support.scans import Part, scan
from autograder.checks.ch08_capstone.hidden.exact_limits import OPEN
from autograder.checks.ch08_capstone.hidden.tracks import TURNS
from autograder.checks.ch08_capstone.support.system import Received, System

AHEAD = Part(-10.0, 10.0, 0.4)
_DOES = {-1: "turned right", 0: "did not turn", 1: "turned left"}


def expect_turn_kept(system: System, stand: Callable[[], object], situation: str) -> None:
    """Fail the check if a robot turns another way after it stood still, when the other side has more room by then.

    Whether it turned at all, and to the right side, is for another check to say.
    """
    system.see(OPEN)
    before = _way(system.see(scan(AHEAD, beside(-1.0, 0.8))))
    stand()
    after = _way(system.see(scan(AHEAD, beside(1.0, 0.5))))
    said = f"{situation}, it {_DOES[after]}, though it {_DOES[before]} before and the way was not clear yet."
    expect(after == before, said, fraction=0.75)


def beside(sign: float, distance: float) -> Part:
    """Return something at the left (1) or the right (-1)."""
    return Part(90.0 * sign - 20.0, 90.0 * sign + 20.0, distance)


def _way(received: Received) -> int:
    """Return to which side the newest command turns: 1 is left, -1 right, 0 neither."""
    expect(bool(received.commands), "No command came on cmd_vel.")
    rate = received.commands[-1].message.angular.z
    return int(math.copysign(1, rate)) if abs(rate) > TURNS else 0
