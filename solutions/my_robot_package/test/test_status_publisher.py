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

"""What the status says, and that a late watcher still gets it."""

import math
from pathlib import Path

from my_robot_interfaces.msg import RobotStatus
from my_robot_interfaces.srv import CheckTrip
from my_robot_package.nodes.status_publisher import (
    battery_percent, STATUS_QOS, StatusPublisher)
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import BatteryState, JointState
import yaml


@pytest.mark.parametrize(('percentage', 'expected'), [
    (0.0, 0), (0.854, 85), (1.0, 100), (math.nan, -1), (1.5, -1), (-0.1, -1),
])
def test_the_battery_is_in_whole_percent_or_unknown(percentage, expected):
    """The driver counts from 0 to 1, and says nan for "not known"."""
    assert battery_percent(BatteryState(percentage=percentage)) == expected


def test_a_battery_never_heard_of_is_unknown():
    """No message is not an empty battery."""
    assert battery_percent(None) == RobotStatus.BATTERY_UNKNOWN


def test_a_late_watcher_gets_what_the_sensors_said(world):
    """The summary holds the name, the battery and the joints, and waits for whoever joins."""
    publisher = world.add(StatusPublisher(
        context=world.context,
        parameter_overrides=[
            Parameter('robot_name', value='Wall-hugger'),
            Parameter('status_period', value=0.05),
        ],
    ))
    publisher.battery_callback(BatteryState(
        percentage=0.4, power_supply_status=BatteryState.POWER_SUPPLY_STATUS_CHARGING))
    publisher.joint_callback(JointState(position=[0.1, 0.2]))
    publisher.publish_status()
    watcher = world.add(Node('watcher', context=world.context))
    heard = []
    watcher.create_subscription(RobotStatus, 'robot_status', heard.append, STATUS_QOS)
    world.until(lambda: heard)
    assert heard[0].robot_name == 'Wall-hugger'
    assert heard[0].battery_level == 40
    assert heard[0].is_charging
    assert list(heard[0].joint_positions) == pytest.approx([0.1, 0.2])
    assert heard[0].header.stamp.sec > 0


@pytest.mark.parametrize(('legs', 'reserve', 'left', 'possible'), [
    ([], 20, 40, True),
    ([50.0, 50.0], 20, 20, True),
    ([50.0, 51.0], 20, 19, False),
    ([0.5], 20, 39, True),
    ([200.0], 0, 0, True),
    ([201.0], 0, 0, False),
    ([1e300], 0, 0, False),
    ([1e308, 1e308], 1, 0, False),
    ([10.0, -1.0], 0, RobotStatus.BATTERY_UNKNOWN, False),
    ([math.nan], 0, RobotStatus.BATTERY_UNKNOWN, False),
    ([math.inf], 0, RobotStatus.BATTERY_UNKNOWN, False),
])
def test_a_trip_is_judged_by_the_battery(world, legs, reserve, left, possible):
    """At 40 %, and 5 m for one percent; a reason is given when the trip is not possible."""
    publisher = world.add(StatusPublisher(context=world.context))
    publisher.battery_callback(BatteryState(percentage=0.4))
    request = CheckTrip.Request(legs=legs, reserve=reserve)
    answer = publisher.check_trip(request, CheckTrip.Response())
    assert (answer.battery_at_end, answer.possible) == (left, possible)
    assert bool(answer.reason) is not possible


def test_no_trip_is_possible_on_a_battery_never_heard_of(world):
    """Over the wire: the service answers, and keeps some charge in reserve by default."""
    world.add(StatusPublisher(context=world.context))
    client = world.add(Node('client', context=world.context)).create_client(
        CheckTrip, 'check_trip')
    world.until(client.service_is_ready)
    future = client.call_async(CheckTrip.Request(legs=[1.0]))
    world.until(future.done)
    assert not future.result().possible
    assert future.result().battery_at_end == RobotStatus.BATTERY_UNKNOWN
    assert 'unknown' in future.result().reason
    assert CheckTrip.Request().reserve == 20


def test_the_configuration_names_only_declared_parameters(world):
    """A name that no node declares would be ignored without a word."""
    path = Path(__file__).parents[1] / 'config' / 'robot_params.yaml'
    config = yaml.safe_load(path.read_text())
    node = world.add(StatusPublisher(context=world.context))
    assert list(config) == [node.get_name()]
    for name, value in config[node.get_name()]['ros__parameters'].items():
        assert node.get_parameter(name).value == value


def test_a_period_outside_its_range_is_refused(world):
    """A parameter's descriptor guards its value."""
    with pytest.raises(Exception, match='status_period'):
        StatusPublisher(
            context=world.context, parameter_overrides=[Parameter('status_period', value=0.0)])
