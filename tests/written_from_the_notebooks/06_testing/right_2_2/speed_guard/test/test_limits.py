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

"""Whether safe_speed is safe, and lets the robot go where it may."""

import math

from pytest import approx, mark, raises
from speed_guard.limits import safe_speed


class TestContract:
    """One method for each line of the table in safe_speed, in its order, and more."""

    def test_line_1_a_pair_without_sense(self):
        """Not even a robot that goes back, stands or is blind gets an answer."""
        for pair in [(-1e-6, 1.0), (-2.0, -1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.999999)]:
            for wanted in (1.0, 0.0, -1.0):
                for distance in (5.0, 0.0, math.inf, math.nan, None):
                    with raises(ValueError):
                        safe_speed(wanted, distance, *pair)

    def test_line_1_a_pair_with_sense(self):
        """A stop_distance of 0 is allowed, and a short line, too."""
        assert safe_speed(1.0, 0.0, stop_distance=0.0, slow_distance=1.0) == 0.0
        assert safe_speed(1.0, 0.25, stop_distance=0.0, slow_distance=1.0) == approx(0.25)
        assert safe_speed(1.0, 1.001, stop_distance=0.999, slow_distance=1.0) == approx(1.0)
        assert safe_speed(1.0, 0.998, stop_distance=0.999, slow_distance=1.0) == 0.0

    @mark.parametrize('distance', [None, math.nan, -math.inf, 0.0, 0.5, 0.8, 1.5, math.inf])
    def test_line_2_not_forward(self, distance):
        """What is not forward is not touched."""
        for wanted in (0.0, -1e-3, -0.5, -4.0):
            assert safe_speed(wanted, distance) == approx(wanted)
            assert safe_speed(wanted, distance, 1.0, 9.0) == approx(wanted)

    def test_line_3_not_known(self):
        """None and nan are no free way, for no speed and for no pair."""
        for unknown in (None, math.nan):
            for wanted in (1e-3, 0.5, 4.0):
                assert safe_speed(wanted, unknown) == 0.0
                assert safe_speed(wanted, unknown, 0.0, 0.1) == 0.0

    def test_line_4_near(self):
        """Also a distance that cannot be."""
        for wanted in (1e-3, 0.5, 4.0):
            for distance in (0.5, 0.4999, 0.2, 0.0, -0.3, -math.inf):
                assert safe_speed(wanted, distance) == 0.0

    def test_line_5_far(self):
        """Also no thing at all."""
        for wanted in (1e-3, 0.5, 4.0):
            for distance in (1.5, 1.5001, 3.0, 1e6, math.inf):
                assert safe_speed(wanted, distance) == approx(wanted)

    def test_line_6_neither(self):
        """Equal steps of the distance are equal steps of the speed, from one end to the other."""
        for wanted in (0.1, 0.5, 4.0):
            for step in range(1, 20):
                assert safe_speed(wanted, 0.5 + step / 20) == approx(wanted * step / 20)
        assert safe_speed(1.0, 0.5 + 1e-3) == approx(1e-3)
        assert safe_speed(1.0, 1.5 - 1e-3) == approx(1.0 - 1e-3)

    def test_the_ends_of_the_line(self):
        """They are the third and the fourth argument, and each has a name and a default."""
        assert safe_speed(1.0, 5.0, 4.0, 8.0) == approx(0.25)
        assert safe_speed(1.0, 7.0, slow_distance=8.0, stop_distance=4.0) == approx(0.75)
        assert safe_speed(1.0, 1.25, stop_distance=1.0) == approx(0.5)
        assert safe_speed(1.0, 1.0, slow_distance=2.5) == approx(0.25)
