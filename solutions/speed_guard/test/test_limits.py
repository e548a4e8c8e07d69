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

"""Tests of safe_speed: one for each line of its contract."""

import math

import pytest
from speed_guard.limits import safe_speed


@pytest.mark.parametrize('distance', [-math.inf, 0.0, 0.3, 0.5])
def test_near_things_stop_it(distance):
    """At stop_distance or nearer, a forward speed becomes 0.0."""
    assert safe_speed(0.8, distance) == 0.0


def test_in_between_it_slows_down():
    """From stop_distance to slow_distance, the speed grows linearly from 0 to the wanted speed."""
    assert safe_speed(0.8, 0.75) == pytest.approx(0.2)
    assert safe_speed(0.8, 1.0) == pytest.approx(0.4)
    assert safe_speed(0.8, 1.25) == pytest.approx(0.6)


def test_far_things_do_not_matter():
    """At slow_distance or farther, the robot drives at the wanted speed, never faster."""
    assert safe_speed(0.8, 1.5) == pytest.approx(0.8)
    assert safe_speed(0.8, 4.0) == pytest.approx(0.8)


def test_nothing_ahead_is_far_away():
    """A distance of inf means that the way is clear."""
    assert safe_speed(0.8, math.inf) == pytest.approx(0.8)


def test_an_unknown_distance_is_not_a_clear_way():
    """With None or nan as the distance, a forward speed becomes 0.0."""
    assert safe_speed(0.8, None) == 0.0
    assert safe_speed(0.8, math.nan) == 0.0


def test_the_way_back_is_not_guarded():
    """A speed of 0 or below stays as it is at every distance, known or not."""
    for distance in (0.1, 1.0, math.inf, math.nan, None):
        assert safe_speed(-0.3, distance) == -0.3
        assert safe_speed(0.0, distance) == 0.0


def test_the_two_distances_can_be_chosen():
    """stop_distance and slow_distance set the range in which the robot slows down."""
    assert safe_speed(1.0, 2.0, stop_distance=1.0, slow_distance=3.0) == pytest.approx(0.5)
    assert safe_speed(1.0, 0.9, stop_distance=1.0, slow_distance=3.0) == 0.0
    assert safe_speed(1.0, 0.2, stop_distance=0.0, slow_distance=0.4) == pytest.approx(0.5)


def test_distances_that_make_no_sense_are_refused():
    """For every wanted speed, ValueError is raised unless 0 <= stop_distance < slow_distance."""
    for stop, slow in ((-0.1, 1.0), (1.0, 1.0), (2.0, 1.0)):
        for wanted in (0.8, -0.8):
            with pytest.raises(ValueError):
                safe_speed(wanted, 1.0, stop, slow)
