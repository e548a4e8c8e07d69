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

"""Which way the robot chooses."""

from types import SimpleNamespace

import pytest
from robot_navigation_tutorial.steering import choose_turn, LEFT, MARGIN, RIGHT, STRAIGHT

INF = float('inf')
SAFE = 0.6


def clearance(front, left=1.0, right=1.0):
    """Return distances as a Clearance holds them."""
    return SimpleNamespace(front=front, left=left, right=right)


@pytest.mark.parametrize('front', [SAFE, 3.0, INF])
def test_a_clear_way_is_taken(front):
    """As near as the safety distance is still clear."""
    assert choose_turn(clearance(front), SAFE, STRAIGHT) == STRAIGHT


@pytest.mark.parametrize(('left', 'right', 'turn'), [
    (2.0, 1.0, LEFT), (1.0, 2.0, RIGHT), (1.0, 1.0, LEFT), (INF, INF, LEFT), (-INF, 0.2, RIGHT),
])
def test_it_turns_towards_the_side_with_more_room(left, right, turn):
    """Left when both have the same."""
    assert choose_turn(clearance(0.5, left, right), SAFE, STRAIGHT) == turn


@pytest.mark.parametrize(('turn', 'left', 'right'), [(LEFT, 0.5, 2.0), (RIGHT, 2.0, 0.5)])
def test_a_turn_keeps_its_direction(turn, left, right):
    """However the sides look by then."""
    assert choose_turn(clearance(0.5, left, right), SAFE, turn) == turn


@pytest.mark.parametrize('turn', [LEFT, RIGHT])
def test_a_turn_ends_with_a_margin(turn):
    """A little more room than what began it."""
    assert choose_turn(clearance(SAFE + MARGIN / 2), SAFE, turn) == turn
    assert choose_turn(clearance(SAFE + MARGIN + 0.01), SAFE, turn) == STRAIGHT


def test_something_too_near_to_measure_is_in_the_way():
    """-inf is smaller than any distance."""
    assert choose_turn(clearance(-INF), SAFE, STRAIGHT) == LEFT
