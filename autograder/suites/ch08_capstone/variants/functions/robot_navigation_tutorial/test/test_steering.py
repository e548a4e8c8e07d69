"""Decisions."""

from robot_navigation_tutorial.steering import Turn, decide


def test_a_turn_ends_with_a_margin():
    """And begins at the limit."""
    assert decide(0.5, 1.0, 2.0, 0.6, Turn.NONE) is Turn.RIGHT
    assert decide(0.65, 1.0, 2.0, 0.6, Turn.RIGHT) is Turn.RIGHT
    assert decide(0.8, 1.0, 2.0, 0.6, Turn.RIGHT) is Turn.NONE
