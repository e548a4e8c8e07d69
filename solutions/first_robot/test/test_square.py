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


"""What the robot is told to do, second by second."""

from first_robot.square import command_at, SIDE_SECONDS, SPEED, TURN_RATE, TURN_SECONDS
import pytest

ROUND = SIDE_SECONDS + TURN_SECONDS


@pytest.mark.parametrize('seconds', [0.0, SIDE_SECONDS - 0.01, ROUND, 7 * ROUND + 1.0])
def test_it_drives_straight_on_along_a_side(seconds):
    """A side starts with each round."""
    assert command_at(seconds) == (SPEED, 0.0)


@pytest.mark.parametrize('seconds', [SIDE_SECONDS, ROUND - 0.01, 7 * ROUND + SIDE_SECONDS + 0.5])
def test_it_turns_on_the_spot_at_a_corner(seconds):
    """A corner is turned, not driven around."""
    assert command_at(seconds) == (0.0, TURN_RATE)
