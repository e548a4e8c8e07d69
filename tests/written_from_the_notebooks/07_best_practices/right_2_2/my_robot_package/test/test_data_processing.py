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

"""What counts as a measurement, and what is remembered of it."""

from math import inf, isnan, nan

from my_robot_package.utils.data_processing import DataProcessor, mask_invalid, mean_distance
import pytest

LIMITS = {'range_min': 0.12, 'range_max': 3.5}


@pytest.mark.parametrize('reading', [0.12, 1.0, 3.5, inf, -inf])
def test_a_measurement_stays_as_it_is(reading):
    """The limits belong to the range, and both infinities say something."""
    assert mask_invalid([reading], **LIMITS) == [reading]


@pytest.mark.parametrize('reading', [nan, 0.0, 0.119, 3.51, -1.0])
def test_a_phantom_becomes_nan(reading):
    """A number that the lidar cannot have measured is no distance."""
    assert isnan(mask_invalid([reading], **LIMITS)[0])


def test_every_reading_keeps_its_place():
    """A reading's place is its bearing."""
    masked = mask_invalid([0.0, 1.0, nan, 2.0], **LIMITS)
    assert masked[1::2] == [1.0, 2.0]
    assert [isnan(reading) for reading in masked] == [True, False, True, False]


def test_the_mean_is_over_measured_distances():
    """An infinity is no distance, and without a distance there is no mean."""
    assert mean_distance([1.0, nan, 2.0, inf]) == pytest.approx(1.5)
    assert mean_distance([nan, inf]) is None
    assert mean_distance([]) is None


def test_only_the_newest_means_are_kept():
    """The history has a length, and a scan without a distance leaves no entry."""
    processor = DataProcessor(history=2)
    for ranges in ([1.0], [nan], [2.0], [3.0]):
        processor.process(ranges, **LIMITS)
    assert processor.average() == pytest.approx(2.5)


def test_without_a_distance_there_is_no_average():
    """Nothing seen is not zero metres."""
    assert DataProcessor().average() is None
