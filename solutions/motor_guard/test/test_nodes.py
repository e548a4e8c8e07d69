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

"""Each node alone: what comes in, what goes out."""

from itertools import pairwise
import math

from motor_guard.guard import Guard
from motor_guard.smoother import Smoother
from motor_guard.thermometer import Thermometer
from motor_guard_interfaces.msg import Decision, Temperature
import pytest
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter


class Peer:
    """The other end of a node's topics."""

    def __init__(self, world, kind, hears, tells=''):
        self.world, self.heard = world, []
        self.node = world.add(Node('peer', context=world.context))
        self.node.create_subscription(kind, hears, self.heard.append, 10)
        self.publisher = self.node.create_publisher(Temperature, tells, 10) if tells else None

    def hear(self, count):
        """Wait for so many messages; return them."""
        self.world.until(lambda: len(self.heard) >= count)
        return self.heard

    def tell(self, *temperatures):
        """Publish temperatures, stamped with the seconds 0, 1, 2, ..."""
        self.world.until(lambda: self.publisher.get_subscription_count())
        for second, celsius in enumerate(temperatures):
            message = Temperature(celsius=celsius)
            message.stamp.sec = second
            self.publisher.publish(message)


@pytest.fixture
def make(world):
    """Return a function that starts a node with parameters."""

    def start(kind, **parameters):
        given = [Parameter(name, value=value) for name, value in parameters.items()]
        return world.add(kind(context=world.context, parameter_overrides=given))

    return start


def test_the_thermometer_swings_around_its_mean(world, make):
    """Each reading is stamped, and a quarter of a turn after the start the motor is hottest."""
    peer = Peer(world, Temperature, 'temperature')
    thermometer = make(Thermometer, period=3600.0, mean=30.0, swing=8.0)
    world.until(lambda: thermometer.publisher.get_subscription_count())
    for _ in range(6):
        thermometer.timer_callback()
    seen = peer.hear(6)
    assert [reading.celsius for reading in seen] == pytest.approx(
        [30.0 + 8.0 * math.sin(math.tau * number / 20) for number in range(6)], abs=1e-4)
    times = [(reading.stamp.sec, reading.stamp.nanosec) for reading in seen]
    assert all(before < after for before, after in pairwise(times))


def test_the_thermometer_measures_by_itself(world, make):
    """Its timer does not stop after one reading."""
    peer = Peer(world, Temperature, 'temperature')
    make(Thermometer, period=0.01)
    assert len(peer.hear(3)) >= 3


def test_an_average_is_taken_over_the_window_and_over_numbers_only(world, make):
    """Three readings at most, and what is not finite is passed over."""
    make(Smoother, window=3)
    peer = Peer(world, Temperature, 'smoothed', 'temperature')
    peer.tell(10.0, 20.0, math.nan, math.inf, 30.0, 40.0)
    averages = peer.hear(4)
    assert [average.celsius for average in averages] == [10.0, 15.0, 20.0, 30.0]
    assert [average.stamp.sec for average in averages] == [0, 1, 4, 5]


def test_a_window_without_readings_is_refused(make):
    """An average over nothing is none."""
    with pytest.raises(InvalidParameterValueException):
        make(Smoother, window=0)


@pytest.mark.parametrize(('parameters', 'temperatures', 'cooling'), [
    ({}, [59.9, 60.0, 55.0, 50.1, 50.0, 55.0, 59.9], [False, True, True, True] + [False] * 3),
    ({'hot': 30.0, 'cool': 20.0}, [25.0, 31.0, 25.0, 19.0], [False, True, True, False]),
    ({}, [20.0, math.nan, 55.0, 20.0], [False, True, True, False]),
])
def test_the_guard_keeps_its_mind_between_the_thresholds(
        world, make, parameters, temperatures, cooling):
    """On from hot, off from cool, as it was between them; on when nothing is known."""
    make(Guard, **parameters)
    peer = Peer(world, Decision, 'decision', 'smoothed')
    peer.tell(*temperatures)
    decisions = peer.hear(len(temperatures))
    assert [decision.cooling for decision in decisions] == cooling
    assert [decision.stamp.sec for decision in decisions] == list(range(len(temperatures)))


@pytest.mark.parametrize('cool', [60.0, 70.0])
def test_thresholds_in_the_wrong_order_are_refused(make, cool):
    """There has to be room between them."""
    with pytest.raises(ValueError, match='less than hot'):
        make(Guard, cool=cool)
