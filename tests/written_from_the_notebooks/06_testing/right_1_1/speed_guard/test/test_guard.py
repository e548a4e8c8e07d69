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

"""The contract of the node speed_guard: what comes out when this goes in."""

import math
import time

from geometry_msgs.msg import Twist, Vector3
import pytest
from rclpy.parameter import Parameter
from speed_guard.guard import SpeedGuard

NEVER = 100.0  # s: a timeout that no test lives to see


@pytest.fixture
def start(robot):
    """Return a function that brings up a guard; it returns once guard and robot have met."""
    def bring_up(**values):
        given = [Parameter(key, value=values[key]) for key in values]
        robot.add(SpeedGuard(context=robot.context, parameter_overrides=given))
        robot.meet()
    return bring_up


@pytest.fixture
def speed(robot):
    """Return a function that says what becomes of 0.8 m/s, after a distance if one is given."""
    def answer(distance=None):
        if distance is not None:
            robot.see(distance)
        return robot.ask(0.8).linear.x
    return answer


def in_time(seconds, story):
    """Return what story() returns; tell it anew when a busy computer took too long for it."""
    for _ in range(5):
        began = time.monotonic()
        end = story()
        if time.monotonic() - began < seconds:
            return end
    pytest.skip(f'the computer is too busy to do this within {seconds:g} s')


class TestTheNode:
    """How it is found, and how it is configured."""

    def test_its_name_is_speed_guard(self, robot, start):
        start()
        robot.until(lambda: 'speed_guard' in robot.get_node_names())

    def test_the_distances_have_defaults(self, start, speed):
        start(timeout=NEVER)
        assert speed(0.5) == pytest.approx(0.0)
        assert speed(0.75) == pytest.approx(0.2)
        assert speed(1.25) == pytest.approx(0.6)
        assert speed(1.5) == pytest.approx(0.8)

    def test_the_timeout_has_a_default(self, robot, start, speed):
        start()

        def story():
            robot.see(9.0)
            robot.spin(0.3)
            return speed()

        assert in_time(0.5, story) == pytest.approx(0.8)
        robot.see(9.0)
        robot.spin(0.6)
        assert speed() == 0.0

    def test_stop_distance_is_a_parameter(self, start, speed):
        start(timeout=NEVER, stop_distance=1.0)
        assert speed(1.0) == pytest.approx(0.0)
        assert speed(1.25) == pytest.approx(0.4)
        assert speed(1.5) == pytest.approx(0.8)

    def test_slow_distance_is_a_parameter(self, start, speed):
        start(timeout=NEVER, slow_distance=4.5)
        assert speed(0.5) == pytest.approx(0.0)
        assert speed(2.5) == pytest.approx(0.4)
        assert speed(4.5) == pytest.approx(0.8)


class TestTheAnswer:
    """What becomes of a command."""

    def test_only_linear_x_is_changed(self, robot, start):
        start(timeout=NEVER)
        for distance, share in ((None, 0.0), (9.0, 1.0), (1.0, 0.5), (0.1, 0.0)):
            if distance is not None:
                robot.see(distance)
            for wanted in (0.5, -0.5):
                count = len(robot.commands)
                robot.planner.publish(Twist(
                    linear=Vector3(x=wanted, y=-0.25, z=7.0),
                    angular=Vector3(x=0.125, y=-3.0, z=-1.5)))
                robot.until(lambda before=count: len(robot.commands) > before)
                answer = robot.commands[-1]
                assert answer.linear.x == pytest.approx(wanted * share if wanted > 0 else wanted)
                assert (answer.linear.y, answer.linear.z) == (-0.25, 7.0)
                assert answer.angular == Vector3(x=0.125, y=-3.0, z=-1.5)

    def test_there_is_one_for_each_command(self, robot, start, speed):
        start(timeout=NEVER)
        for distance in (None, 9.0, 1.0, 0.1):
            speed(distance)
            speed()
        robot.spin(0.3)
        assert [command.linear.z for command in robot.commands] == [1, 2, 3, 4, 5, 6, 7, 8]

    def test_there_is_none_without_a_command(self, robot, start):
        start(timeout=NEVER)
        for distance in (9.0, 1.0, 0.1):
            robot.see(distance)
        robot.spin(0.3)
        assert robot.commands == []

    def test_the_way_back_is_free(self, robot, start):
        start(timeout=NEVER)
        assert robot.ask(-0.3).linear.x == -0.3
        robot.see(0.1)
        assert robot.ask(-0.3).linear.x == -0.3
        assert robot.ask(0.0).linear.x == 0.0


class TestTheDistance:
    """Which distance a command is judged by."""

    def test_there_is_none_at_first(self, start, speed):
        start(timeout=NEVER)
        assert speed() == 0.0

    def test_it_is_the_newest(self, start, speed):
        start(timeout=NEVER)
        for distance, expected in ((9.0, 0.8), (0.1, 0.0), (1.0, 0.4), (1.25, 0.6), (0.75, 0.2)):
            assert speed(distance) == pytest.approx(expected)

    def test_it_serves_more_than_one_command(self, start, speed):
        start(timeout=NEVER)
        assert [speed(9.0), speed(), speed()] == pytest.approx([0.8, 0.8, 0.8])

    def test_inf_is_clear_and_nan_is_not(self, start, speed):
        start(timeout=NEVER)
        assert speed(math.inf) == pytest.approx(0.8)
        assert speed(math.nan) == 0.0

    def test_it_is_known_for_as_long_as_the_timeout(self, robot, start, speed):
        start(timeout=2.0)

        def story():
            robot.see(9.0)
            robot.spin(1.2)
            return speed()

        assert in_time(2.0, story) == pytest.approx(0.8)

    def test_it_is_not_known_for_longer(self, robot, start, speed):
        start(timeout=0.2)
        robot.see(9.0)
        robot.spin(0.3)
        assert speed() == 0.0

    def test_it_grows_old_beside_commands(self, robot, start, speed):
        start(timeout=0.5)
        robot.see(9.0)
        began = time.monotonic()
        while time.monotonic() < began + 0.7:
            speed()
        assert speed() == 0.0

    def test_a_new_one_is_known_again(self, robot, start, speed):
        start(timeout=1.0)
        robot.see(9.0)
        robot.spin(1.2)
        assert speed() == 0.0
        assert in_time(1.0, lambda: speed(9.0)) == pytest.approx(0.8)


class TestTheStop:
    """What comes when no command comes."""

    def test_there_is_none_before_the_first_command(self, robot, start):
        start(timeout=0.1)
        robot.see(9.0)
        robot.spin(0.5)
        assert robot.commands == []

    def test_it_comes_once_after_each_series_of_commands(self, robot, start):
        start(timeout=1.0)
        for stops in (1, 2):
            began = time.monotonic()
            robot.ask(-0.3, turn=0.7, side=0.2)
            robot.spin(0.6)
            if time.monotonic() - began < 1.0:
                assert len(robot.commands) == 2 * stops - 1, 'it came too early'
            robot.until(lambda count=2 * stops: len(robot.commands) >= count, seconds=1.0)
            robot.spin(1.3)
            assert len(robot.commands) == 2 * stops
            assert robot.commands[-1] == Twist()

    def test_distances_do_not_delay_it(self, robot, start):
        start(timeout=0.5)
        robot.ask(-0.3)
        robot.until(lambda: robot.see(9.0) or len(robot.commands) > 1, seconds=1.5)
        assert robot.commands[-1] == Twist()

    def test_it_does_not_come_between_commands(self, robot, start):
        start(timeout=1.0)

        def longest_gap():
            times = []
            for _ in range(6):
                if times:
                    robot.spin(0.3)
                times.append(time.monotonic())
                robot.ask(-0.3)
                times.append(time.monotonic())
            return max(later - earlier for earlier, later in zip(times[::2], times[3::2]))

        if longest_gap() < 1.0:
            assert len(robot.commands) == 6
