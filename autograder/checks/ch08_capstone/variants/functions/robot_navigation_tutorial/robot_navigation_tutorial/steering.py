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
    if before is not Turn.NONE and front >= limit + 0.1:
        return Turn.NONE
    return before
