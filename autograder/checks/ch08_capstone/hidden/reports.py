"""Steps a system until the newest report of the monitor has a certain age."""

from __future__ import annotations

from collections.abc import Callable

from autograder.checks.ch08_capstone.support.system import System

# s from the newest report to the last message on a topic. At two reports a second, another report then comes 1.15 to
# 1.25 s after that message.
MIN_PHASE, MAX_PHASE = 0.25, 0.35


def repeat_until_phase(system: System, step: Callable[[], object]) -> None:
    """Repeat a step of 0.1 s until the newest report is about 0.3 s old, 10 times at most.

    The next report then comes at the same time after the last step, whichever checks ran before.
    """
    for _ in range(10):
        newest = system.harness.messages("/health")[-1:]
        if newest and MIN_PHASE <= system.seconds - newest[0].seconds < MAX_PHASE:
            return
        step()
