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


"""What counts as near."""

from math import inf, nan

import pytest
from sensor_msgs.msg import LaserScan
from wall_alarm.utils.nearest import nearest


@pytest.mark.parametrize(('ranges', 'expected'), [
    ([2.0, 0.5, 3.0], 0.5),
    ([nan, 0.5, 0.0, 12.0], 0.5),
    ([inf, inf], inf),
    ([inf, -inf, 1.0], -inf),
    ([nan, 0.0], None),
    ([], None),
])
def test_the_nearest_reading_that_counts_is_returned(ranges, expected):
    """Failed beams and phantoms do not count, and no reading at all is None."""
    assert nearest(LaserScan(range_min=0.1, range_max=10.0, ranges=ranges)) == expected
