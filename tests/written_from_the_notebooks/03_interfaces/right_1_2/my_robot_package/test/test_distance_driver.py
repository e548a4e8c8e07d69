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

"""What the distance driver accepts, and how a goal ends."""

import math
import threading

from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from my_robot_package.nodes.distance_driver import DistanceDriver
from nav_msgs.msg import Odometry
import pytest
from rclpy.action import ActionClient
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node


class Robot(Node):
    """Wheels that obey at once, and whoever sends the goals."""

    def __init__(self, context):
        super().__init__('robot', context=context)
        self.x = 3.0
        self.stuck = False
        self.commands = []
        self.feedback = []
        self.odometry = self.create_publisher(Odometry, 'odom', 10)
        self.create_subscription(Twist, 'cmd_vel', self.obey, 10)
        self.client = ActionClient(self, DriveDistance, 'drive_distance')

    def obey(self, command):
        """Roll on by a tenth of a second."""
        self.commands.append(command.linear.x)
        if not self.stuck:
            self.x += 0.1 * command.linear.x
        self.tell()

    def tell(self):
        """Publish where the robot is."""
        odometry = Odometry()
        odometry.pose.pose.position.x = self.x
        self.odometry.publish(odometry)

    def send(self, **goal):
        """Send a goal; return the future of its handle."""
        return self.client.send_goal_async(
            DriveDistance.Goal(**goal), lambda message: self.feedback.append(message.feedback))


@pytest.fixture
def driver(world):
    """Return a driver that spins beside the test, as its main() would spin it."""
    driver = DistanceDriver(context=world.context)
    executor = MultiThreadedExecutor(context=world.context)
    executor.add_node(driver)
    over = threading.Event()

    def spin():
        """Look now and then whether the test is over: shutdown() can miss a thread that waits."""
        while not over.is_set():
            executor.spin_once(timeout_sec=0.1)

    thread = threading.Thread(target=spin)
    thread.start()
    yield driver
    over.set()
    thread.join()
    executor.shutdown()
    driver.destroy_node()


@pytest.fixture
def robot(world, driver):
    """Return a robot whose driver knows where it stands."""
    robot = world.add(Robot(world.context))
    world.until(lambda: robot.odometry.get_subscription_count() and robot.client.server_is_ready())
    robot.tell()
    world.until(lambda: driver.position is not None)
    return robot


def handle_of(world, sent):
    """Return the handle of a goal that was sent."""
    world.until(sent.done)
    return sent.result()


def outcome(world, handle):
    """Return an accepted goal's status and result."""
    ended = handle.get_result_async()
    world.until(ended.done)
    return ended.result().status, ended.result().result


def test_it_drives_the_distance_and_stops(world, robot):
    """The goal succeeds, with feedback on the way and a stop at the end."""
    handle = handle_of(world, robot.send(distance=0.1, speed=0.4))
    assert handle.accepted
    status, result = outcome(world, handle)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert result.driven == pytest.approx(0.12)  # three commands of 4 cm
    assert result.reason == ''
    world.until(lambda: robot.commands[-1] == 0.0 and robot.feedback)
    assert robot.commands == [0.4, 0.4, 0.4, 0.0]
    for feedback in robot.feedback:
        assert feedback.driven + feedback.remaining == pytest.approx(0.1)


@pytest.mark.parametrize('goal', [
    {'distance': 0.0}, {'distance': -1.0}, {'distance': 5.1}, {'distance': math.nan},
    {'distance': 1.0, 'speed': 0.0}, {'distance': 1.0, 'speed': 0.6},
    {'distance': 1.0, 'speed': math.nan},
])
def test_a_goal_that_cannot_be_driven_is_rejected(world, robot, goal):
    """And the robot does not move."""
    assert not handle_of(world, robot.send(**goal)).accepted
    assert robot.commands == []


def test_a_second_goal_is_rejected_while_one_is_driven_and_a_cancel_stops_it(world, robot):
    """The first goal goes on until it is cancelled; then there is room for another."""
    first = handle_of(world, robot.send(distance=5.0))
    world.until(lambda: robot.feedback)
    assert not handle_of(world, robot.send(distance=1.0)).accepted
    first.cancel_goal_async()
    status, result = outcome(world, first)
    assert status == GoalStatus.STATUS_CANCELED and 'cancel' in result.reason
    assert 0.0 <= result.driven < 5.0
    world.until(lambda: robot.commands[-1] == 0.0)
    again = handle_of(world, robot.send(distance=0.01, speed=0.5))
    assert again.accepted
    assert outcome(world, again)[0] == GoalStatus.STATUS_SUCCEEDED


def test_a_robot_that_is_stuck_gives_up(world, robot):
    """Wheels that do not turn must not be driven for ever."""
    robot.stuck = True
    status, result = outcome(world, handle_of(world, robot.send(distance=1.0)))
    assert status == GoalStatus.STATUS_ABORTED
    assert result.driven == 0.0
    assert 'stuck' in result.reason
    world.until(lambda: robot.commands[-1] == 0.0)


def test_without_odometry_no_goal_is_accepted(world, driver):
    """A robot that does not know where it is cannot know how far it has come."""
    robot = world.add(Robot(world.context))
    world.until(robot.client.server_is_ready)
    assert not handle_of(world, robot.send(distance=1.0)).accepted
