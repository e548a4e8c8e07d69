"""The first beat."""

from autograder.checking import Workspace, group, hint
from autograder.checks.ch02_beat.support.beating import expect_beats

check = group("beat")


@check(points=1, covers="counts")
@hint("self.publisher.publish(UInt32(data=...))")
def test_first_beat(workspace: Workspace) -> None:
    """Its first beat is 1."""
    expect_beats(workspace, 0.3, 1)
