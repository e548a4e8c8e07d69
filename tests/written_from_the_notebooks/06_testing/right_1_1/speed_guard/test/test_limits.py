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

"""The contract of safe_speed, as cases of unittest."""

import math
from unittest import TestCase

import pytest
from speed_guard.limits import safe_speed

UNKNOWN = (None, math.nan)
KNOWN = (-math.inf, 0.0, 0.2, 0.5, 1.0, 1.5, 3.0, math.inf)


class ForwardTest(TestCase):
    """What becomes of a speed above 0 with the distances that are the defaults."""

    def test_at_stop_distance_and_nearer_it_stands(self):
        for distance in (0.5, 0.4999, 0.2, 0.0, -math.inf):
            self.assertEqual(safe_speed(0.8, distance), 0.0, distance)

    def test_between_the_two_it_is_on_a_straight_line(self):
        for part in (0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99):
            for wanted in (0.1, 0.8, 2.0):
                expected = pytest.approx(wanted * part)
                self.assertEqual(safe_speed(wanted, 0.5 + part), expected, (part, wanted))

    def test_at_slow_distance_and_farther_it_is_free(self):
        for distance in (1.5, 1.5001, 2.0, 100.0):
            for wanted in (0.1, 0.8, 2.0):
                expected = pytest.approx(wanted)
                self.assertEqual(safe_speed(wanted, distance), expected, (distance, wanted))

    def test_nothing_ahead_is_a_clear_way(self):
        self.assertEqual(safe_speed(0.8, math.inf), pytest.approx(0.8))

    def test_it_stands_while_nothing_is_known(self):
        for distance in UNKNOWN:
            self.assertEqual(safe_speed(0.8, distance), 0.0, distance)


class BackwardTest(TestCase):
    """What becomes of 0 and of a speed below it."""

    def test_the_way_back_is_free_whatever_is_ahead(self):
        for distance in KNOWN + UNKNOWN:
            for wanted in (-0.01, -0.3, -2.0):
                self.assertEqual(safe_speed(wanted, distance), wanted, (distance, wanted))

    def test_standing_stays_standing(self):
        for distance in KNOWN + UNKNOWN:
            self.assertEqual(safe_speed(0.0, distance), 0.0, distance)


class OptionsTest(TestCase):
    """What the two distances do."""

    def test_they_come_in_the_order_of_the_signature(self):
        self.assertEqual(safe_speed(1.0, 2.5, 1.0, 3.0), pytest.approx(0.75))

    def test_each_of_them_moves_its_end_alone(self):
        self.assertEqual(safe_speed(0.8, 1.0, stop_distance=1.0), 0.0)
        self.assertEqual(safe_speed(0.8, 1.25, stop_distance=1.0), pytest.approx(0.4))
        self.assertEqual(safe_speed(0.8, 1.5, slow_distance=2.5), pytest.approx(0.4))
        self.assertEqual(safe_speed(0.8, 2.5, slow_distance=2.5), pytest.approx(0.8))

    def test_a_stop_distance_of_zero_is_allowed(self):
        self.assertEqual(safe_speed(1.0, 0.25, stop_distance=0.0), pytest.approx(0.25 / 1.5))
        self.assertEqual(safe_speed(1.0, 0.0, stop_distance=0.0), 0.0)

    def refused(self, stop, slow):
        for wanted in (0.8, 0.0, -0.8):
            for distance in (0.1, 1.0, math.inf) + UNKNOWN:
                with self.assertRaises(ValueError, msg=(wanted, distance)):
                    safe_speed(wanted, distance, stop, slow)

    def test_a_stop_distance_below_zero_is_refused(self):
        self.refused(-0.001, 1.5)
        self.refused(-2.0, -1.0)

    def test_equal_distances_are_refused(self):
        self.refused(1.0, 1.0)
        self.refused(0.0, 0.0)

    def test_distances_in_the_wrong_order_are_refused(self):
        self.refused(1.5, 0.5)
