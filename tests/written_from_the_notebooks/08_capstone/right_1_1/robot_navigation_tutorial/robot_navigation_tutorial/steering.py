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

"""Straight on, to the left, or to the right."""

STRAIGHT, LEFT, RIGHT = 0, 1, -1
MARGIN = 0.1  # m


def choose_turn(clearance, safety_distance, turn):
    """Return what to do next, given what was done before."""
    needed = safety_distance
    if turn != STRAIGHT:
        needed += MARGIN
    if clearance.front >= needed:
        return STRAIGHT
    if turn != STRAIGHT:
        return turn
    return RIGHT if clearance.right > clearance.left else LEFT
