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

"""The choice between three ways to go."""

STRAIGHT, LEFT, RIGHT = 0, 1, -1
MARGIN = 0.1  # m: so much more room than the safety distance ends a turn


def choose_turn(clearance, safety_distance, turn):
    """Choose STRAIGHT, LEFT or RIGHT."""
    match turn:
        case 0:  # straight until now
            if clearance.front >= safety_distance:
                return STRAIGHT
            return max((LEFT, clearance.left), (RIGHT, clearance.right), key=lambda it: it[1])[0]
        case _:
            return STRAIGHT if clearance.front >= safety_distance + MARGIN else turn
