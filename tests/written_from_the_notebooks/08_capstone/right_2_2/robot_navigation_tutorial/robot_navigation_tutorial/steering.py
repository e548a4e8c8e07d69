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

"""A small state machine with three states."""

STRAIGHT, LEFT, RIGHT = 0, 1, -1
MARGIN = 0.1  # m


def _start(clearance, safety_distance):
    """Leave STRAIGHT, or not."""
    blocked = clearance.front < safety_distance
    more_to_the_left = clearance.left >= clearance.right
    return (LEFT if more_to_the_left else RIGHT) if blocked else STRAIGHT


def choose_turn(clearance, safety_distance, turn):
    """Return the state after this one: STRAIGHT, LEFT or RIGHT."""
    if turn == STRAIGHT:
        return _start(clearance, safety_distance)
    is_clear = clearance.front >= safety_distance + MARGIN
    return STRAIGHT if is_clear else turn
