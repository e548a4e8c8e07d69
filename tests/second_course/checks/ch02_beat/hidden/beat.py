"""Some beats, as many as are drawn."""

import random

from autograder.checks.ch02_beat.support.beating import expect_beats
from autograder.harness import Workspace
from autograder.suite import group, hint

check = group("beat")


@check(points=3, holds="counts")
@hint("self.publisher.publish(UInt32(data=...))")
def test_beats(workspace: Workspace, draw: random.Random) -> None:
    """It counts its beats."""
    count = draw.randint(4, 9)
    expect_beats(workspace, 0.2 * count + 0.1, count)
