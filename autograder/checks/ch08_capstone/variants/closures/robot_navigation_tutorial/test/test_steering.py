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

"""The turns of the pilot."""

from robot_navigation_tutorial.steering import pilot


def test_the_pilot_keeps_its_mind():
    """It turns right, keeps that while the left is wider, and then drives straight on."""
    decide = pilot()
    assert decide(0.5, 1.0, 2.0, 0.6) == -1
    assert decide(0.65, 3.0, 1.0, 0.6) == -1
    assert decide(0.75, 3.0, 1.0, 0.6) == 0
