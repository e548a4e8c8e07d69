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


"""The steps of the dance: along one side of a square, then a quarter turn to the left."""

import math

FORWARD_SPEED = 0.25  # m/s
TURN_RATE = math.pi / 8  # rad/s, positive is to the left
TURN_SECONDS = math.pi / 2 / TURN_RATE


def step_at(seconds, side):
    """
    Return the speed in m/s and the turn rate in rad/s at a moment of the dance.

    seconds is the time since the dance began, side the length of a side in metres.
    """
    straight = side / FORWARD_SPEED
    if seconds % (straight + TURN_SECONDS) < straight:
        return FORWARD_SPEED, 0.0
    return 0.0, TURN_RATE
