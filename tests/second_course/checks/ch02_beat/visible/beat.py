"""The first beat."""

from autograder.checks.ch02_beat.support.beating import expect_beats
from autograder.harness import Workspace
from autograder.suite import group, hint

check = group("beat")


@check(points=1, holds="counts")
@hint("self.publisher.publish(UInt32(data=...))")
def test_first_beat(workspace: Workspace) -> None:
    """Its first beat is 1."""
    expect_beats(workspace, 0.3, 1)
