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

"""The states and their transitions."""

from types import SimpleNamespace

from robot_navigation_tutorial.steering import Straight, Turning


def test_a_turn_goes_to_the_wider_side_and_ends_beyond_the_limit():
    """It goes left, and straight on once the way is clear."""
    turning = Straight().next(SimpleNamespace(front=0.3, left=2.0, right=1.0), 0.6)
    assert turning.side == 1
    assert turning.next(SimpleNamespace(front=0.65), 0.6) is turning
    assert isinstance(Turning(-1).next(SimpleNamespace(front=0.8), 0.6), Straight)
