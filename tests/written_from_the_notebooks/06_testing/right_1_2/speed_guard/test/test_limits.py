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

"""One table of what safe_speed answers, and one of what it refuses."""

from math import inf, nan

import pytest
from speed_guard.limits import safe_speed

ANSWERS = (
    # wanted, distance, other arguments, answer
    (0.8, -inf, {}, 0.0),
    (0.8, 0.0, {}, 0.0),
    (0.8, 0.49, {}, 0.0),
    (0.8, 0.5, {}, 0.0),
    (0.8, 0.51, {}, 0.008),
    (0.8, 0.75, {}, 0.2),
    (0.8, 1.0, {}, 0.4),
    (0.4, 1.0, {}, 0.2),
    (0.8, 1.25, {}, 0.6),
    (0.8, 1.49, {}, 0.792),
    (0.8, 1.5, {}, 0.8),
    (0.8, 1.6, {}, 0.8),
    (0.8, 9.0, {}, 0.8),
    (5.0, 9.0, {}, 5.0),
    (0.8, inf, {}, 0.8),
    (0.8, None, {}, 0.0),
    (0.8, nan, {}, 0.0),
    (0.0, 0.1, {}, 0.0),
    (0.0, 9.0, {}, 0.0),
    (0.0, nan, {}, 0.0),
    (0.0, None, {}, 0.0),
    (-0.3, -inf, {}, -0.3),
    (-0.3, 0.1, {}, -0.3),
    (-0.3, 1.0, {}, -0.3),
    (-0.3, 9.0, {}, -0.3),
    (-0.3, inf, {}, -0.3),
    (-0.3, nan, {}, -0.3),
    (-0.3, None, {}, -0.3),
    (-5.0, 0.1, {}, -5.0),
    (1.0, 0.9, {'stop_distance': 1.0, 'slow_distance': 3.0}, 0.0),
    (1.0, 2.0, {'stop_distance': 1.0, 'slow_distance': 3.0}, 0.5),
    (1.0, 2.9, {'stop_distance': 1.0, 'slow_distance': 3.0}, 0.95),
    (1.0, 3.1, {'stop_distance': 1.0, 'slow_distance': 3.0}, 1.0),
    (1.0, 1.0, {'stop_distance': 0.9}, 1 / 6),
    (1.0, 1.5, {'slow_distance': 4.5}, 0.25),
    (1.0, 0.0, {'stop_distance': 0.0}, 0.0),
    (1.0, 0.1, {'stop_distance': 0.0, 'slow_distance': 0.4}, 0.25),
)
REFUSED = ((-0.01, 1.5), (-1.0, -0.5), (0.0, 0.0), (1.0, 1.0), (1.0, 0.99), (1.5, 0.5))


@pytest.mark.parametrize(('wanted', 'distance', 'others', 'answer'), ANSWERS)
def test_answer(wanted, distance, others, answer):
    assert safe_speed(wanted, distance, **others) == pytest.approx(answer)


@pytest.mark.parametrize('distances', REFUSED)
@pytest.mark.parametrize('wanted', [0.8, 0.0, -0.8])
@pytest.mark.parametrize('distance', [0.2, 9.0, inf, nan, None])
def test_refusal(wanted, distance, distances):
    with pytest.raises(ValueError):
        safe_speed(wanted, distance, *distances)
