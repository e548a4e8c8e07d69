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


"""What the node says while its sensor fails, and after."""

import random

from my_robot_package.nodes.robust_node import read_sensor, RobustNode, SensorError, STATUS_QOS
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String


class Scripted:
    """A generator whose numbers are known beforehand."""

    def __init__(self, *numbers):
        self._numbers = iter(numbers)

    def random(self):
        """Return the next number."""
        return next(self._numbers)


@pytest.fixture
def heard(world):
    """Collect what is said on status."""
    said = []
    world.add(Node('listener', context=world.context)).create_subscription(
        String, 'status', lambda msg: said.append(msg.data), STATUS_QOS)
    return said


def robust(world, *numbers, **parameters):
    """Return a node whose sensor fails at each number below 0.5."""
    values = {'failure_probability': 0.5, **parameters}
    return world.add(RobustNode(
        Scripted(*numbers),
        context=world.context,
        parameter_overrides=[Parameter(name, value=value) for name, value in values.items()],
    ))


def say(world, heard, node):
    """Let the node try once; return what it said."""
    count = len(heard)
    node.timer_callback()
    world.until(lambda: len(heard) > count)
    return heard[-1]


def test_the_sensor_fails_as_often_as_it_is_told_to():
    """The number decides, and the limit itself is a success."""
    assert read_sensor(Scripted(0.5), 0.5) == 'Success'
    with pytest.raises(SensorError):
        read_sensor(Scripted(0.49), 0.5)


def test_failures_are_counted_until_a_reading_succeeds(world, heard):
    """One success wipes the slate clean."""
    node = robust(world, 0.1, 0.2, 0.9, 0.3)
    world.until(lambda: node.count_subscribers('status') == 1)
    said = [say(world, heard, node) for _ in range(4)]
    assert said == ['failed: 1 in a row', 'failed: 2 in a row', 'ok', 'failed: 1 in a row']


def test_too_many_failures_in_a_row_are_unstable(world, heard):
    """The limit itself is still borne."""
    node = robust(world, 0.1, 0.1, 0.1, max_errors=2)
    world.until(lambda: node.count_subscribers('status') == 1)
    said = [say(world, heard, node) for _ in range(3)]
    assert said[1:] == ['failed: 2 in a row', 'unstable: 3 in a row']


def test_a_bug_is_not_taken_for_a_failure(world):
    """Only what is expected is caught."""
    node = robust(world)  # a generator without numbers
    with pytest.raises(StopIteration):
        node.timer_callback()


def test_the_same_seed_gives_the_same_numbers(world):
    """A run can be repeated."""
    node = world.add(RobustNode(
        context=world.context, parameter_overrides=[Parameter('seed', value=7)]))
    assert node.generator.random() == random.Random(7).random()


def test_a_probability_above_one_is_refused(world):
    """The descriptor's range guards the value."""
    with pytest.raises(Exception, match='failure_probability'):
        robust(world, failure_probability=1.5)
