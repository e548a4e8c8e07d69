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


"""What the dance is made of."""

import math

import pytest
from square_dance.utils.steps import step_at


@pytest.mark.parametrize('side', [0.5, 1.0, 2.0])
def test_four_sides_and_four_turns_come_back_to_the_start(side):
    """Adding up all steps of one square leads nowhere."""
    x, y, heading, dt = 0.0, 0.0, 0.0, 0.01
    for tick in range(round(4 * (side / 0.25 + 4.0) / dt)):
        speed, rate = step_at(tick * dt, side)
        x += speed * math.cos(heading) * dt
        y += speed * math.sin(heading) * dt
        heading += rate * dt
    assert math.hypot(x, y) < 0.05
    assert heading == pytest.approx(math.tau, abs=0.05)


def test_it_drives_straight_first_and_then_turns_to_the_left():
    """A side of 1 m takes 4 s, and the turn starts right after it."""
    assert step_at(0.0, 1.0) == (0.25, 0.0)
    speed, rate = step_at(4.0, 1.0)
    assert (speed, rate > 0.0) == (0.0, True)
