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

"""The node drives by its parameters, at the start and after each change."""

from math import inf, nan
from pathlib import Path

from my_robot_package.configuration import contradiction
from my_robot_package.nodes.configured_node import ConfiguredNode
import pytest
from rclpy.exceptions import (
    InvalidParameterTypeException, InvalidParameterValueException,
    ParameterNotDeclaredException)
from rclpy.parameter import Parameter
from sensor_msgs.msg import BatteryState, LaserScan
import yaml

CONFIG = Path(__file__).parents[1] / 'config'


@pytest.fixture
def make(world):
    """Return a function that starts the node with values of its own."""
    def make(*arguments, **values):
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        return world.add(ConfiguredNode(
            context=world.context, parameter_overrides=overrides, cli_args=arguments or None))
    return make


def see(node, distance):
    """Show the node one scan with a reading straight ahead."""
    node.scan_callback(LaserScan(angle_increment=0.1, ranges=[distance, 9.0, 9.0]))


def change(node, **values):
    """Set parameters together, as one request; return the node's answer."""
    return node.set_parameters_atomically(
        [Parameter(name, value=value) for name, value in values.items()])


@pytest.mark.parametrize(('distance', 'expected'), [
    (2.0, 0.4), (inf, 0.4), (1.0, 0.4), (0.75, 0.2), (0.5, 0.0), (0.1, 0.0), (nan, 0.0),
    (-inf, 0.0), (0.0, 0.0),
])
def test_the_speed_falls_to_nothing_at_the_safety_distance(make, distance, expected):
    """Full speed beyond slow_distance; what is no distance is no reason to drive."""
    node = make(max_linear_velocity=0.4, safety_distance=0.5, slow_distance=1.0)
    see(node, distance)
    assert node.speed() == pytest.approx(expected)


def test_it_looks_straight_ahead_wherever_a_scan_begins(make):
    """The beam of bearing 0 counts, not the first one."""
    node = make()
    node.scan_callback(
        LaserScan(angle_min=-0.2, angle_increment=0.1, ranges=[0.1, 0.1, 9.0, 0.1, 0.1]))
    assert node.speed() == pytest.approx(0.3)


def test_it_stands_still_when_blind(make, world):
    """Before the first scan, and once the last one is too old."""
    node = make()
    assert node.speed() == 0.0
    see(node, inf)
    assert node.speed() > 0.0
    world.until(lambda: node.speed() == 0.0)


@pytest.mark.parametrize(('percentage', 'drives'), [(0.6, True), (0.4, False), (nan, True)])
def test_it_stands_still_with_a_battery_below_the_threshold(make, percentage, drives):
    """An unknown charge is no low charge."""
    node = make(battery_threshold=50)
    see(node, inf)
    node.battery_callback(BatteryState(percentage=percentage))
    assert (node.speed() > 0.0) is drives


@pytest.mark.parametrize(('safety', 'slow', 'fits'), [(0.5, 1.0, True), (1.0, 1.0, False)])
def test_a_contradiction_names_both_values(safety, slow, fits):
    """An empty sentence means that there is none."""
    sentence = contradiction(safety, slow)
    assert (sentence == '') is fits
    assert fits or all(text in sentence for text in ('safety_distance', 'slow_distance', '1.0'))


def test_two_distances_move_together_or_not_at_all(make):
    """One request is judged as a whole."""
    node = make(safety_distance=0.5, slow_distance=1.0)
    refused = change(node, safety_distance=1.5)
    assert not refused.successful
    assert refused.reason == contradiction(1.5, 1.0)
    assert not change(node, control_frequency=20.0, safety_distance=1.5).successful
    assert node.timer.timer_period_ns == 100_000_000
    assert change(node, safety_distance=1.5, slow_distance=2.0).successful
    see(node, 1.4)
    assert node.speed() == 0.0


def test_a_new_frequency_sets_the_timer(make):
    """And nothing else touches it."""
    node = make(control_frequency=20.0)
    assert node.timer.timer_period_ns == 50_000_000
    assert change(node, control_frequency=25.0).successful
    assert node.timer.timer_period_ns == 40_000_000
    assert change(node, max_linear_velocity=0.1).successful
    assert node.timer.timer_period_ns == 40_000_000


@pytest.mark.parametrize(('name', 'value', 'why'), [
    ('max_linear_velocity', -1.0, 'out of range'), ('battery_threshold', 101, 'out of range'),
    ('max_linear_velocity', 1, 'Wrong parameter type'), ('robot_name', 'R2', 'read-only'),
])
def test_the_descriptors_guard_each_value(make, name, value, why):
    """ROS refuses, with a reason, and the value stays."""
    node = make()
    before = node.value(name)
    result = change(node, **{name: value})
    assert not result.successful
    assert why in result.reason
    assert node.value(name) == before


def test_an_undeclared_name_is_refused(make):
    """A parameter is part of the node's contract."""
    with pytest.raises(ParameterNotDeclaredException):
        change(make(), safty_distance=0.7)


@pytest.mark.parametrize(('values', 'error'), [
    ({'safety_distance': 1.0, 'slow_distance': 0.5}, ValueError),
    ({'max_linear_velocity': 5.0}, InvalidParameterValueException),
    ({'safety_distance': 1}, InvalidParameterTypeException),
])
def test_it_does_not_start_with_values_that_make_no_sense(make, values, error):
    """A wrong file is found at once, not on the road."""
    with pytest.raises(error):
        make(**values)


@pytest.mark.parametrize('name', ['scout', 'porter', 'another'])
def test_the_fleet_file_serves_each_robot(make, name):
    """The shared values, and over them the robot's own."""
    path = CONFIG / 'fleet_params.yaml'
    node = make('--ros-args', '-r', f'__node:={name}', '--params-file', str(path))
    config = yaml.safe_load(path.read_text())
    own = config.get(name, {'ros__parameters': {}})['ros__parameters']
    expected = {**config['/**']['ros__parameters'], **own}
    assert {parameter: node.value(parameter) for parameter in expected} == expected


def test_the_file_for_one_robot_names_only_declared_parameters(make):
    """A name that the node does not declare would be ignored without a word."""
    path = CONFIG / 'configured_node.yaml'
    node = make('--ros-args', '--params-file', str(path))
    values = yaml.safe_load(path.read_text())[node.get_name()]['ros__parameters']
    assert {name: node.value(name) for name in values} == values
