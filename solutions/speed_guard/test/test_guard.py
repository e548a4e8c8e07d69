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

"""Tests of the node speed_guard, through its topics."""

from geometry_msgs.msg import Twist
import pytest
from rclpy.parameter import Parameter
from speed_guard.guard import SpeedGuard

PATIENT = 60.0  # s: nothing becomes old while a test runs
# With HASTY, a distance may be too old when the command arrives: the computer may be busy.
HASTY = 0.1  # s


@pytest.fixture
def guard(robot):
    """Return a function that starts a guard with parameters and waits until it is connected."""
    def start(**parameters):
        overrides = [Parameter(name, value=value) for name, value in parameters.items()]
        node = SpeedGuard(context=robot.context, parameter_overrides=overrides)
        robot.add(node)
        robot.meet()
        return node
    return start


def test_it_is_called_speed_guard(robot, guard):
    """It is called speed_guard: parameters in a file reach it by this name."""
    guard()
    assert ('speed_guard', '/') in robot.get_node_names_and_namespaces()


def test_before_the_first_distance_it_stands(robot, guard):
    """Without a distance, a forward speed becomes 0.0; a backward speed stays as it is."""
    guard(timeout=PATIENT)
    assert robot.ask(0.8).linear.x == 0.0
    assert robot.ask(-0.3).linear.x == -0.3


def test_the_newest_distance_counts(robot, guard):
    """Each command is judged by what the sensor said last."""
    guard(timeout=PATIENT)
    for distance, speed in ((4.0, 0.8), (1.0, 0.4), (0.2, 0.0), (1.25, 0.6)):
        robot.see(distance)
        assert robot.ask(0.8).linear.x == pytest.approx(speed)


def test_a_turn_stays_as_it_is(robot, guard):
    """Only linear.x may change; all other fields stay as they are, whether it brakes or not."""
    guard(timeout=PATIENT)
    for distance, speed in ((4.0, 0.8), (0.2, 0.0)):
        robot.see(distance)
        answer = robot.ask(0.8, turn=0.7, side=0.1)
        fields = answer.linear.x, answer.linear.y, answer.angular.z
        assert fields == pytest.approx((speed, 0.1, 0.7))


def test_each_command_has_one_answer(robot, guard):
    """As many commands come out as went in."""
    guard(timeout=PATIENT)
    for _ in range(5):
        robot.ask(0.8)
    robot.spin(0.1)
    assert len(robot.commands) == 5


def test_its_distances_are_parameters(robot, guard):
    """stop_distance and slow_distance set the range in which the robot slows down."""
    guard(timeout=PATIENT, stop_distance=1.0, slow_distance=3.0)
    for distance, speed in ((0.9, 0.0), (2.0, 0.4), (3.5, 0.8)):
        robot.see(distance)
        assert robot.ask(0.8).linear.x == pytest.approx(speed)


def test_its_parameters_have_defaults(robot, guard):
    """Without overrides, the parameters are those of the contract: 0.5 m, 1.5 m and 0.5 s."""
    node = guard()
    names = 'stop_distance', 'slow_distance', 'timeout'
    assert [node.get_parameter(name).value for name in names] == [0.5, 1.5, 0.5]


def test_an_old_distance_is_not_known(robot, guard):
    """A distance that came more than timeout seconds ago is not known."""
    guard(timeout=HASTY)
    robot.see(4.0)
    robot.spin(2 * HASTY)
    assert robot.ask(0.8).linear.x == 0.0


def test_commands_do_not_keep_a_distance_young(robot, guard):
    """A distance gets old even while commands come."""
    guard(timeout=1.0)
    robot.see(4.0)
    robot.until(lambda: robot.ask(0.8).linear.x == 0.0, seconds=3.0)


def test_the_motors_stop_once_when_the_planner_falls_silent(robot, guard):
    """One command of zeros follows the last command; before the first, nothing is published."""
    guard(timeout=HASTY)
    robot.spin(2 * HASTY)
    assert robot.commands == []
    for answers in (2, 4):
        robot.ask(-0.3, turn=0.7)
        robot.until(lambda count=answers: len(robot.commands) >= count)
        robot.spin(2 * HASTY)
        assert len(robot.commands) == answers
        assert robot.commands[-1] == Twist()
