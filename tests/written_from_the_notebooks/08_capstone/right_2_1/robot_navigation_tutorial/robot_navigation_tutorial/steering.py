"""Straight on, left or right."""

STRAIGHT = 0
LEFT = 1
RIGHT = -1
MARGIN = 0.1  # m


def choose_turn(clearance, safety_distance, turn):
    """
    Choose by the room around, and by the choice before.

    A turn begins when something ahead is nearer than safety_distance (m), and goes on in its
    direction until there is MARGIN more room than that.
    """
    turns_already = turn in (LEFT, RIGHT)
    needed = safety_distance + MARGIN if turns_already else safety_distance
    if clearance.front >= needed:
        return STRAIGHT
    if turns_already:
        return turn
    if clearance.right > clearance.left:
        return RIGHT
    return LEFT
