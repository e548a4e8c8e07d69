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

"""The contract of safe_speed as tables: what goes in, and what comes out."""

from math import inf, nan

import pytest
from speed_guard.limits import safe_speed

UNKNOWN = (None, nan)
ANYWHERE = (*UNKNOWN, -inf, -1.0, 0.0, 0.2, 0.5, 0.9, 1.5, 7.0, inf)


@pytest.mark.parametrize('wanted', [-2.0, -0.4, 0.0, 0.01, 0.4, 2.0])
@pytest.mark.parametrize('distance', [None, nan, 0.1, 1.0, inf])
@pytest.mark.parametrize(('stop', 'slow'), [
    (-0.01, 1.5), (-3.0, -2.0), (0.0, 0.0), (0.7, 0.7), (0.71, 0.7), (1.5, 0.5), (0.5, -0.5),
])
def test_first_of_all_the_two_distances_have_to_make_sense(wanted, distance, stop, slow):
    """Whatever else is asked, a wrong pair is a ValueError."""
    with pytest.raises(ValueError):
        safe_speed(wanted, distance, stop_distance=stop, slow_distance=slow)


@pytest.mark.parametrize('distance', ANYWHERE)
@pytest.mark.parametrize('wanted', [-30.0, -0.8, -0.001, 0.0])
def test_back_and_standing_still_are_free(wanted, distance):
    """No distance, and no missing one, changes a speed that is not above 0."""
    assert safe_speed(wanted, distance) == wanted


@pytest.mark.parametrize('distance', UNKNOWN)
@pytest.mark.parametrize('wanted', [0.001, 0.8, 30.0])
def test_who_does_not_see_does_not_go_forward(wanted, distance):
    """An unknown distance means 0.0."""
    assert safe_speed(wanted, distance) == 0.0


@pytest.mark.parametrize('distance', [-inf, -1.0, 0.0, 0.25, 0.499, 0.5])
@pytest.mark.parametrize('wanted', [0.001, 0.8, 30.0])
def test_it_stops_at_the_stop_distance(wanted, distance):
    """Up to and with 0.5 m."""
    assert safe_speed(wanted, distance) == 0.0


@pytest.mark.parametrize('distance', [1.5, 1.501, 2.5, 1000.0, inf])
@pytest.mark.parametrize('wanted', [0.001, 0.8, 30.0])
def test_it_goes_as_wanted_from_the_slow_distance_on(wanted, distance):
    """From 1.5 m on, and nothing is added."""
    assert safe_speed(wanted, distance) == pytest.approx(wanted)


@pytest.mark.parametrize('percent', [1, 10, 25, 40, 50, 60, 75, 90, 99])
@pytest.mark.parametrize('wanted', [0.2, 0.8, 30.0])
def test_between_them_the_speed_is_in_proportion(wanted, percent):
    """So many percent of the way from 0.5 m to 1.5 m are so many percent of the speed."""
    share = percent / 100
    assert safe_speed(wanted, 0.5 + share) == pytest.approx(share * wanted)


@pytest.mark.parametrize(('stop', 'slow', 'distance', 'expected'), [
    (0.0, 2.0, 0.0, 0.0), (0.0, 2.0, 0.5, 0.2), (0.0, 2.0, 2.0, 0.8),
    (0.1, 0.2, 0.1, 0.0), (0.1, 0.2, 0.175, 0.6), (0.1, 0.2, 0.2, 0.8), (0.1, 0.2, 0.3, 0.8),
    (2.0, 6.0, 1.9, 0.0), (2.0, 6.0, 2.0, 0.0), (2.0, 6.0, 3.0, 0.2), (2.0, 6.0, 6.5, 0.8),
])
def test_other_distances_move_the_line(stop, slow, distance, expected):
    """By position and by name."""
    assert safe_speed(0.8, distance, stop, slow) == pytest.approx(expected)
    assert safe_speed(
        0.8, distance, slow_distance=slow, stop_distance=stop) == pytest.approx(expected)


def test_each_distance_has_a_default_of_its_own():
    """One of them may be given without the other."""
    assert safe_speed(0.8, 1.0, stop_distance=0.75) == pytest.approx(0.8 / 3)
    assert safe_speed(0.8, 1.0, slow_distance=2.5) == pytest.approx(0.2)
