"""The choice of a turn."""

STRAIGHT, LEFT, RIGHT = 0, 1, -1
MARGIN = 0.1


def choose_turn(clearance, safety_distance, turn):
    """Return STRAIGHT, LEFT or RIGHT."""
    if turn == STRAIGHT:
        if clearance.front >= safety_distance:
            return STRAIGHT
        return RIGHT if clearance.right > clearance.left else LEFT
    return STRAIGHT if clearance.front >= safety_distance + MARGIN else turn
