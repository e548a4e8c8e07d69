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

"""The choice of a turn, as a pure function of distances and the last turn."""

from enum import IntEnum


class Turn(IntEnum):
    """The direction in which the robot turns."""

    RIGHT = -1
    NONE = 0
    LEFT = 1


def decide(front, left, right, limit, last):
    """Return the next turn."""
    if last is Turn.NONE and front < limit:
        return Turn.RIGHT if right > left else Turn.LEFT
    if last is not Turn.NONE and front >= limit + 0.1:
        return Turn.NONE
    return last
