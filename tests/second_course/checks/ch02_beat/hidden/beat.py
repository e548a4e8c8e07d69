"""A random number of beats."""

import random

from autograder.checking import Workspace, group, hint
from autograder.checks.ch02_beat.support.beating import expect_beats

check = group("beat")


@check(points=3, covers="counts")
@hint("self.publisher.publish(UInt32(data=...))")
def test_beats(workspace: Workspace, draw: random.Random) -> None:
    """It counts its beats."""
    count = draw.randint(4, 9)
    expect_beats(workspace, 0.2 * count + 0.1, count)
