"""The check that students run themselves. No hidden check uses the same scan."""

from autograder.checking import group, hint
from autograder.checks.chNEW_CHAPTER.support.robot import Robot, expect_nearest

check = group("readings")


@check(points=1, covers="nearest")
@hint("on_scan gets each scan. Publish a Float32, whose field data is the number.")
def test_one_scan(robot: Robot) -> None:
    """It publishes the nearest reading of one scan."""
    expect_nearest(robot, [2.0, 0.7, 1.5, 3.0], 0.7)
