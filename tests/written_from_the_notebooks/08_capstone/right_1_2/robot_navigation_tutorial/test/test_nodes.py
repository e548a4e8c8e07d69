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

import math
from pathlib import Path

from geometry_msgs.msg import Twist
import pytest
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_sensor_data
from robot_navigation_interfaces.msg import Clearance, Health
from robot_navigation_tutorial.navigation_controller import NavigationController
from robot_navigation_tutorial.sensor_processor import SensorProcessor
from robot_navigation_tutorial.status_monitor import HEALTH_QOS, StatusMonitor
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool
import yaml

STOP, FORWARD = (0.0, 0.0), (0.3, 0.0)
LEFT, RIGHT = (0.0, 0.75 * 0.8), (0.0, -0.75 * 0.8)


@pytest.fixture
def simulated(world):
    """
    Return a function that adds a node in simulated time.

    It stands still, however long a busy computer takes, until later() lets some of it pass.
    """

    def add(make):
        override = Parameter('use_sim_time', value=True)
        return world.add(make(context=world.context, parameter_overrides=[override]))

    return add


def later(node, seconds):
    """Let time pass for a node: of its timers, each that is due ticks once."""
    clock = node.get_clock()
    clock.set_ros_time_override(clock.now() + Duration(seconds=seconds))


@pytest.fixture
def peer(world):
    """Return a node that stands at the other end of the topics."""
    return world.add(Node('peer', context=world.context))


def seen(controller, **content):
    """Return a clearance of this moment: nothing around, but for what is given."""
    clearance = Clearance(**{'valid': True, 'front': 3.0, 'left': 3.0, 'right': 3.0, **content})
    clearance.header.stamp = controller.get_clock().now().to_msg()
    return clearance


@pytest.fixture
def controller(simulated):
    """Return a controller."""
    return simulated(NavigationController)


@pytest.fixture
def command(world, peer, controller):
    """Return a function that lets the controller decide, and gives speed and turn rate."""
    commands = []
    peer.create_subscription(Twist, 'cmd_vel', commands.append, 10)
    world.until(controller.publisher.get_subscription_count)

    def decide():
        controller.control()
        world.until(lambda: commands)
        twist = commands.pop()
        return twist.linear.x, twist.angular.z

    return decide


@pytest.mark.parametrize(('content', 'expected'), [
    ({}, FORWARD),
    ({'front': 0.5}, LEFT),
    ({'front': 0.5, 'left': 1.0, 'right': 2.0}, RIGHT),
    ({'front': -math.inf}, LEFT),
    ({'valid': False}, STOP),
])
def test_the_controller_decides_by_the_newest_clearance(controller, command, content, expected):
    """Forward, a turn, or a stop when it cannot be trusted."""
    assert command() == STOP  # nothing has been seen yet
    controller.clearance_callback(seen(controller, **content))
    assert command() == expected


def test_the_controller_stops_when_the_clearance_is_old(controller, command):
    """A robot that nobody tells where the walls are must not drive on."""
    controller.clearance_callback(seen(controller))
    assert command() == FORWARD
    later(controller, 1.0)
    assert command() == STOP


def test_the_clearance_comes_over_its_topic(world, peer, controller, command):
    """The subscription is there, too."""
    publisher = peer.create_publisher(Clearance, 'clearance', 10)
    world.until(publisher.get_subscription_count)
    publisher.publish(seen(controller))
    world.until(lambda: controller.clearance)
    assert command() == FORWARD


def test_driving_can_be_switched_off_and_on(world, peer, controller, command):
    """A service holds the robot still."""
    client = peer.create_client(SetBool, 'enable')
    assert client.wait_for_service(10.0)
    for wanted, expected in ((False, STOP), (True, FORWARD)):
        future = client.call_async(SetBool.Request(data=wanted))
        world.until(future.done)
        assert future.result().success
        controller.clearance_callback(seen(controller))
        assert command() == expected


def test_a_parameter_has_an_effect_at_once(controller, command):
    """It is read whenever it is needed."""
    controller.set_parameters([Parameter('safety_distance', value=2.0)])
    controller.clearance_callback(seen(controller, front=1.5))
    assert command() == LEFT


def test_the_processor_answers_a_scan_with_its_clearance(world, peer):
    """The header is the scan's own, and a blind sector makes the whole invalid."""
    world.add(SensorProcessor(context=world.context))
    found = []
    lidar = peer.create_publisher(LaserScan, 'scan', qos_profile_sensor_data)
    peer.create_subscription(Clearance, 'clearance', found.append, 10)

    def show(name, left):
        scan = LaserScan(range_min=0.1, range_max=10.0, angle_increment=math.radians(1.0))
        scan.header.frame_id = name
        scan.ranges = [2.0] * 60 + [left] * 61 + [2.0] * 239
        # Best effort: a scan may be lost, the next one comes.
        timer = peer.create_timer(0.05, lambda: lidar.publish(scan))
        world.until(lambda: found and found[-1].header.frame_id == name)
        timer.cancel()
        return found[-1]

    clear = show('laser', 1.5)
    assert (clear.valid, clear.front, clear.left, clear.right) == (True, 2.0, 1.5, 2.0)
    assert not show('blind on the left', math.nan).valid


def test_a_late_watcher_gets_the_last_report(world):
    """At first nothing is heard; whoever joins later still learns it."""
    monitor = world.add(StatusMonitor(context=world.context))
    monitor.report()
    heard = []
    watcher = world.add(Node('watcher', context=world.context))
    watcher.create_subscription(Health, 'health', heard.append, HEALTH_QOS)
    world.until(lambda: heard)
    assert heard[0].level == Health.FAILED
    assert list(heard[0].silent) == ['scan', 'clearance', 'cmd_vel']


@pytest.mark.parametrize(('valid', 'silent', 'level'), [
    (True, None, Health.OK), (False, None, Health.DEGRADED), (True, 'scan', Health.FAILED),
])
def test_the_level_follows_what_is_heard(world, peer, simulated, valid, silent, level):
    """One silent topic is worse than a blocked lidar."""
    monitor = simulated(StatusMonitor)
    monitor.clearance_callback(Clearance(valid=valid))
    for topic in ('scan', 'cmd_vel'):
        if topic != silent:
            monitor.hear(topic)
    heard = []
    peer.create_subscription(Health, 'health', heard.append, HEALTH_QOS)
    monitor.report()
    world.until(lambda: heard)
    assert heard[0].level == level
    assert list(heard[0].silent) == ([silent] if silent else [])


@pytest.mark.parametrize('make', [SensorProcessor, NavigationController, StatusMonitor])
def test_the_configuration_holds_each_declared_parameter(world, make):
    """A name that no node declares would be ignored without a word."""
    path = Path(__file__).parents[1] / 'config' / 'navigation.yaml'
    node = world.add(make(context=world.context))
    values = yaml.safe_load(path.read_text())[node.get_name()]['ros__parameters']
    built_in = set(Node('plain', context=world.context).get_parameters_by_prefix(''))
    assert set(values) == set(node.get_parameters_by_prefix('')) - built_in
    for name, value in values.items():
        assert node.get_parameter(name).value == value


def test_a_value_outside_its_range_is_refused(world):
    """A parameter's descriptor guards its value."""
    with pytest.raises(Exception, match='safety_distance'):
        NavigationController(
            context=world.context, parameter_overrides=[Parameter('safety_distance', value=9.0)])
