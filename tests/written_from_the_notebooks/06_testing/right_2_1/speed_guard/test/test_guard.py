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

"""The guard's contract, one sentence after the other."""

from copy import deepcopy

from geometry_msgs.msg import Twist, Vector3
import pytest
from rclpy.parameter import Parameter
from speed_guard.guard import SpeedGuard

NEVER = 60.0  # s: a timeout that no test lives to see
SOON = 0.2  # s


@pytest.fixture
def guard(robot):
    """Return a function that starts the guard: its arguments are the guard's parameters."""
    def start(**parameters):
        node = SpeedGuard(context=robot.context, parameter_overrides=[
            Parameter(*pair) for pair in typed(parameters)])
        robot.add(node)
        robot.meet()
        return node
    return start


def typed(values):
    """Yield name, type and value of each parameter; all of the guard's are doubles."""
    for name, value in values.items():
        yield name, Parameter.Type.DOUBLE, float(value)


def show(robot, distance):
    """Let the sensor speak, and the guard listen."""
    robot.see(distance)
    robot.spin(0.05)


def exchange(robot, command):
    """Publish a command of any kind; return what comes out for it."""
    count = len(robot.commands)
    robot.planner.publish(command)
    robot.until(lambda: len(robot.commands) > count)
    return robot.commands[count]


def until_stop(robot, count):
    """Wait for a command while the sensor goes on."""
    robot.until(lambda: robot.see(9.0) or len(robot.commands) >= count, seconds=2.0)


def test_name(robot, guard):
    """The whole name is speed_guard, in no namespace."""
    guard()
    robot.until(lambda: ('speed_guard', '/') in robot.get_node_names_and_namespaces())


def test_nothing_seen_yet(robot, guard):
    """Until a distance has come, only forward is forbidden."""
    guard(timeout=NEVER)
    for wanted, expected in ((0.8, 0.0), (-0.8, -0.8), (0.0, 0.0), (0.1, 0.0)):
        assert robot.ask(wanted).linear.x == pytest.approx(expected)


def test_newest_distance(robot, guard):
    """Up and down: it is always the last one that counts, as often as it is asked."""
    guard(timeout=NEVER)
    for distance, expected in (
        (1.0, 0.4), (1.25, 0.6), (9.0, 0.8), (0.75, 0.2), (0.1, 0.0), (float('inf'), 0.8),
        (float('nan'), 0.0), (1.25, 0.6),
    ):
        show(robot, distance)
        for _ in range(2):
            assert robot.ask(0.8).linear.x == pytest.approx(expected)
        assert robot.ask(-0.8).linear.x == pytest.approx(-0.8)


@pytest.mark.parametrize(('distance', 'speed', 'expected'), [
    (9.0, 0.8, 0.8), (1.0, 0.8, 0.4), (0.1, 0.8, 0.0), (0.1, -0.8, -0.8), (9.0, 0.0, 0.0),
])
def test_all_other_fields(robot, guard, distance, speed, expected):
    """Five of the six numbers come out as they went in."""
    guard(timeout=NEVER)
    show(robot, distance)
    sent = Twist(
        linear=Vector3(x=speed, y=-0.2, z=0.3), angular=Vector3(x=0.4, y=-0.5, z=0.6))
    wanted = deepcopy(sent)
    answer = exchange(robot, sent)
    assert answer.linear.x == pytest.approx(expected)
    wanted.linear.x = answer.linear.x
    assert answer == wanted


def test_one_answer_each(robot, guard):
    """A burst of commands comes out as it went in: none is lost, and none is doubled."""
    guard(timeout=NEVER)
    show(robot, 1.0)
    for number in range(1, 6):
        robot.planner.publish(Twist(linear=Vector3(x=0.8, y=float(number))))
    robot.until(lambda: len(robot.commands) >= 5)
    show(robot, 2.0)
    robot.spin(0.3)
    assert [command.linear.y for command in robot.commands] == [1.0, 2.0, 3.0, 4.0, 5.0]


@pytest.mark.parametrize(('parameters', 'distance', 'expected'), [
    ({'stop_distance': 1.0}, 1.1, 0.16),
    ({'slow_distance': 4.5}, 1.5, 0.2),
    ({'stop_distance': 2.0, 'slow_distance': 4.0}, 1.9, 0.0),
    ({'stop_distance': 2.0, 'slow_distance': 4.0}, 3.5, 0.6),
    ({'stop_distance': 0.1, 'slow_distance': 0.2}, 0.3, 0.8),
])
def test_distances_as_parameters(robot, guard, parameters, distance, expected):
    """Each of them alone, and both together."""
    guard(timeout=NEVER, **parameters)
    show(robot, distance)
    assert robot.ask(0.8).linear.x == pytest.approx(expected, rel=1e-5)


def test_defaults(robot, guard):
    """Three numbers of the contract."""
    node = guard()
    for name, value in (('stop_distance', 0.5), ('slow_distance', 1.5), ('timeout', 0.5)):
        assert node.get_parameter(name).value == pytest.approx(value)


def test_a_distance_ages(robot, guard):
    """It is good for the timeout, not for longer; then a new one is good again."""
    guard(timeout=2.0)
    show(robot, 9.0)
    robot.spin(0.8)
    assert robot.ask(0.8).linear.x == pytest.approx(0.8)
    robot.spin(1.5)
    assert robot.ask(0.8).linear.x == 0.0
    assert robot.ask(-0.8).linear.x == pytest.approx(-0.8)
    show(robot, 9.0)
    assert robot.ask(0.8).linear.x == pytest.approx(0.8)


def test_a_distance_ages_under_commands(robot, guard):
    """Asking does not keep it young."""
    guard(timeout=0.5)
    show(robot, 9.0)
    robot.until(lambda: robot.ask(0.8).linear.x == 0.0, seconds=1.5)


def test_no_stop_before_the_first_command(robot, guard):
    """Distances are no commands."""
    guard(timeout=SOON)
    for distance in (9.0, 0.1):
        show(robot, distance)
        robot.spin(2 * SOON)
    assert robot.commands == []


def test_one_stop_in_each_silence(robot, guard):
    """All zeros, once, also the second and third time, and even if the sensor goes on."""
    guard(timeout=SOON)
    for silence in range(1, 4):
        exchange(robot, Twist(linear=Vector3(x=-0.8, y=0.2, z=1.0), angular=Vector3(z=0.6)))
        until_stop(robot, 2 * silence)
        assert robot.commands[-1] == Twist()
        for _ in range(3):
            show(robot, 9.0)
            robot.spin(SOON)
        assert len(robot.commands) == 2 * silence


def test_the_stop_comes_in_time(robot, guard):
    """Not long before the timeout has passed, and not long after."""
    guard(timeout=2.0)
    robot.ask(-0.8)
    robot.spin(0.8)
    assert len(robot.commands) == 1
    robot.until(lambda: len(robot.commands) == 2, seconds=2.5)


def test_no_stop_while_commands_come(robot, guard):
    """It is the newest command that counts, not the first."""
    guard(timeout=1.2)
    for count in range(1, 8):
        robot.ask(-0.8)
        robot.spin(0.25)
        assert len(robot.commands) == count
