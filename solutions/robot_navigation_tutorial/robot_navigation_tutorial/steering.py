# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Which way to go: the part of the navigation controller without ROS."""

STRAIGHT, LEFT, RIGHT = 0, 1, -1
MARGIN = 0.1  # m: a turn ends this far beyond the safety distance


def choose_turn(clearance, safety_distance, turn):
    """
    Return STRAIGHT, LEFT or RIGHT.

    clearance has the distances front, left and right in metres, and turn is the previous
    choice. Something ahead that is nearer than safety_distance starts a turn, towards the
    side with more room, or to the left when both have the same. A turn keeps its direction,
    and ends when front is at least safety_distance + MARGIN.
    """
    if turn == STRAIGHT and clearance.front >= safety_distance:
        return STRAIGHT
    if turn != STRAIGHT:
        return STRAIGHT if clearance.front >= safety_distance + MARGIN else turn
    return LEFT if clearance.left >= clearance.right else RIGHT
