"""Pure decisions: a turn is a state, and it ends when the way is clear."""

from enum import IntEnum


class Turn(IntEnum):
    """Where the robot turns."""

    RIGHT = -1
    NONE = 0
    LEFT = 1


def decide(front, left, right, limit, before):
    """Return the next turn."""
    if before is Turn.NONE and front < limit:
        return Turn.RIGHT if right > left else Turn.LEFT
    if before is not Turn.NONE and front >= limit * 1.2:
        return Turn.NONE
    return before
