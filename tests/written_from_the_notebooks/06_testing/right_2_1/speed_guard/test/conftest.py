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

"""The other side of the guard's topics, in a ROS 2 context that no other test shares."""

from copy import deepcopy
import itertools
import os
import time

from geometry_msgs.msg import Twist
import pytest
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Range

TESTS = itertools.count()
DEADLINE = 5.0  # s: only a broken node makes a test wait this long


class Robot(Node):
    """A planner, a distance sensor, and motors that remember: all that a guard has to do with."""

    def __init__(self, context):
        """Create an endpoint for each of the guard's topics, and the executor of the test."""
        super().__init__('robot', context=context)
        self.sensor = self.create_publisher(Range, 'distance', qos_profile_sensor_data)
        self.planner = self.create_publisher(Twist, 'cmd_vel_raw', 10)
        self.seen = []  # what has come on distance
        self.commands = []  # what has come on cmd_vel
        self.number = 0.0  # of the newest question
        self.create_subscription(Range, 'distance', self.seen.append, qos_profile_sensor_data)
        self.create_subscription(Twist, 'cmd_vel', self.commands.append, 10)
        self.nodes = [self]
        self.test_executor = SingleThreadedExecutor(context=context)
        self.test_executor.add_node(self)

    def add(self, node):
        """Let another node of this process take part in the test; it ends with the robot."""
        self.nodes.append(node)
        self.test_executor.add_node(node)

    def meet(self, seconds=DEADLINE):
        """Wait, so many seconds at most, until a guard is at the other end of all topics."""
        self.until(lambda: self.sensor.get_subscription_count() > 1
                   and self.planner.get_subscription_count() > 0
                   and self.count_publishers('cmd_vel') > 0, seconds)

    def until(self, condition, seconds=DEADLINE):
        """Spin until condition() is true; fail the test when it takes more than `seconds`."""
        end = time.monotonic() + seconds
        while True:
            if condition():
                return
            left = end - time.monotonic()
            if left <= 0.0:
                pytest.fail(f'nothing of that kind within {seconds} s')
            self.test_executor.spin_once(timeout_sec=min(left, 0.02))

    def spin(self, seconds):
        """Spin for some time: the only way to see that nothing happens."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.test_executor.spin_once(timeout_sec=0.05)

    def see(self, distance):
        """Let the sensor publish a distance; wait until it has gone round."""
        count = len(self.seen)
        self.sensor.publish(Range(range=distance))
        self.until(lambda: len(self.seen) > count)

    def ask(self, speed, turn=0.0, side=0.0):
        """Let the planner publish a command; return the answer on cmd_vel."""
        self.number += 1.0
        wanted = Twist()
        wanted.linear.x, wanted.linear.y, wanted.angular.z = speed, side, turn
        wanted.linear.z = self.number  # comes back in the answer; a stop has 0 there
        self.planner.publish(wanted)
        self.until(lambda: self.number in [command.linear.z for command in self.commands])
        heard = next(command for command in self.commands if command.linear.z == self.number)
        answer = deepcopy(heard)
        answer.linear.z = 0.0
        return answer

    def leave(self):
        """End all nodes of the test."""
        self.test_executor.shutdown()
        for node in self.nodes:
            node.destroy_node()


@pytest.fixture
def domain():
    """Return a domain, from 1 to 100, that is not the default one; a test each has its own."""
    default = int(os.environ.get('ROS_DOMAIN_ID') or 0)
    own = [number for number in range(1, 101) if number != default]
    return own[(os.getpid() + next(TESTS)) % len(own)]


@pytest.fixture
def context(domain):
    """Give the test a context of its own in this domain; shut it down after the test."""
    own = Context()
    rclpy.init(context=own, domain_id=domain)
    try:
        yield own
    finally:
        rclpy.try_shutdown(context=own)


@pytest.fixture
def robot(context):
    """Give the test a robot; end its nodes after the test."""
    robot = Robot(context)
    yield robot
    robot.leave()
