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

"""The choice of a turn."""

from robot_navigation_tutorial.steering import Turn, decide


def test_a_turn_ends_with_a_margin():
    """It begins below the limit, and ends 0.1 m above it."""
    assert decide(0.5, 1.0, 2.0, 0.6, Turn.NONE) is Turn.RIGHT
    assert decide(0.65, 1.0, 2.0, 0.6, Turn.RIGHT) is Turn.RIGHT
    assert decide(0.8, 1.0, 2.0, 0.6, Turn.RIGHT) is Turn.NONE
