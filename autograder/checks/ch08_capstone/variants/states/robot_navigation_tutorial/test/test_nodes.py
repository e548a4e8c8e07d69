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

"""The silence of a topic."""

from types import SimpleNamespace

from rclpy.clock import ROSClock
from rclpy.duration import Duration
from robot_navigation_tutorial.status_monitor import Watch


def test_a_watch_tells_silence():
    """Test it before the first message, shortly after it, and after the limit."""
    clock = ROSClock()
    watch = Watch(SimpleNamespace(get_clock=lambda: clock), 'scan')
    assert watch.is_silent(clock.now(), 1.0)
    watch('a scan')
    assert not watch.is_silent(watch.when + Duration(seconds=0.9), 1.0)
    assert watch.is_silent(watch.when + Duration(seconds=1.1), 1.0)
