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

"""Stories of a robot and its guard: what the robot does, step by step, and what it gets."""

from itertools import chain
import time

from geometry_msgs.msg import Twist
import pytest
from speed_guard.guard import SpeedGuard

LONG = {'timeout': 300.0}  # s
STORIES = {
    'it stands before the first distance': (LONG, 'ask 0.8 0.0, ask 0.8 0.0'),
    'the way back needs no distance': (LONG, 'ask -0.3 -0.3, ask 0.0 0.0'),
    'the way back is free': (LONG, 'see 0.1, ask -0.3 -0.3, see 1.0, ask -0.3 -0.3'),
    'the newest distance counts': (
        LONG,
        'see 5.0, ask 0.8 0.8, see 0.25, ask 0.8 0.0, see 1.0, ask 0.8 0.4, '
        'see 0.75, ask 0.8 0.2, see 1.25, ask 0.4 0.3, '
        'see 1.5, ask 0.8 0.8, see 0.5, ask 0.8 0.0'),
    'a distance serves many commands': (LONG, 'see 1.0, ask 0.8 0.4, ask 0.4 0.2, ask 0.8 0.4'),
    'of two distances the second counts': (LONG, 'see 5.0, see 0.25, ask 0.8 0.0'),
    'inf is clear': (LONG, 'see inf, ask 0.8 0.8'),
    'nan is unknown': (LONG, 'see 5.0, ask 0.8 0.8, see nan, ask 0.8 0.0'),
    'stop_distance can be set': (
        {**LONG, 'stop_distance': 1.0}, 'see 1.0, ask 0.8 0.0, see 1.25, ask 0.8 0.4'),
    'slow_distance can be set': (
        {**LONG, 'slow_distance': 4.5}, 'see 2.5, ask 0.8 0.4, see 4.5, ask 0.8 0.8'),
    'both can be set': (
        {**LONG, 'stop_distance': 2.0, 'slow_distance': 4.0},
        'see 1.75, ask 0.8 0.0, see 2.5, ask 0.8 0.2, see 4.25, ask 0.8 0.8'),
    'a distance gets old': ({'timeout': 0.25}, 'see 5.0, spin 0.4, ask 0.8 0.0, ask -0.3 -0.3'),
    'by default it gets old in half a second': ({}, 'see 5.0, spin 0.65, ask 0.8 0.0'),
}


@pytest.fixture
def guarded(robot):
    """Return a function that gives the robot a guard with these parameters."""
    def guard(parameters):
        words = chain.from_iterable(('-p', f'{key}:={parameters[key]}') for key in parameters)
        arguments = ['--ros-args', *words] if parameters else None
        robot.add(SpeedGuard(context=robot.context, cli_args=arguments))
        robot.meet()
        return robot
    return guard


@pytest.mark.parametrize('story', STORIES)
def test_story(guarded, story):
    parameters, steps = STORIES[story]
    robot = guarded(parameters)
    asked = 0
    for step in steps.split(', '):
        verb, number, *rest = step.split()
        if verb == 'ask':
            asked += 1
            assert robot.ask(float(number)).linear.x == pytest.approx(float(rest[0])), step
        else:
            {'see': robot.see, 'spin': robot.spin}[verb](float(number))
    if parameters is LONG:
        robot.spin(0.25)
        assert len(robot.commands) == asked


def test_name(guarded):
    robot = guarded({})
    robot.until(lambda: ('speed_guard', '/') in robot.get_node_names_and_namespaces())


@pytest.mark.parametrize(('distance', 'share'), [(5.0, 1.0), (1.0, 0.5), (0.25, 0.0)])
def test_the_other_fields_stay(guarded, distance, share):
    robot = guarded(LONG)
    robot.see(distance)
    wanted = Twist()
    for number, vector in enumerate((wanted.linear, wanted.angular), start=1):
        vector.x, vector.y, vector.z = 0.5 * number, -0.75 * number, 1.25 * number
    robot.planner.publish(wanted)
    robot.until(lambda: robot.commands)
    answer = robot.commands[0]
    assert answer.linear.x == pytest.approx(0.5 * share)
    answer.linear.x = wanted.linear.x
    assert answer == wanted


@pytest.mark.parametrize('parameters', [{'timeout': 1.5}, {}])
def test_a_distance_is_young_at_first(guarded, parameters):
    robot = guarded(parameters)
    timeout = parameters.get('timeout', 0.5)
    for _ in range(6):
        began = time.monotonic()
        robot.see(5.0)
        robot.spin(0.6 * timeout)
        speed = robot.ask(0.8).linear.x
        if time.monotonic() - began < timeout:  # otherwise the computer was too slow to judge
            assert speed == pytest.approx(0.8)
            return


def test_commands_keep_no_distance_young(guarded):
    robot = guarded({'timeout': 0.6})
    robot.see(5.0)
    end = time.monotonic() + 0.85
    robot.until(lambda: robot.ask(0.8) and time.monotonic() > end)
    assert robot.ask(0.8).linear.x == 0.0


def test_silence_before_the_first_command(guarded):
    robot = guarded({'timeout': 0.2})
    robot.see(5.0)
    robot.spin(0.7)
    assert not robot.commands


@pytest.mark.parametrize('distance', [None, 5.0])
def test_silence_after_commands(guarded, distance):
    """Each series of commands is followed by one stop, in time, and distances change nothing."""
    robot = guarded({'timeout': 0.8})

    def pause():
        if distance is not None:
            robot.see(distance)
        robot.spin(0.05)

    for series in (1, 2, 3):
        count = len(robot.commands)
        last = time.monotonic()
        robot.ask(-0.5, turn=0.5, side=-0.5)
        while time.monotonic() < last + 0.5:
            pause()
        early = len(robot.commands) > count + 1
        assert not early or time.monotonic() > last + 0.8, series
        robot.until(lambda so_far=count: pause() or len(robot.commands) > so_far + 1, seconds=1.0)
        robot.spin(1.1)
        assert len(robot.commands) == count + 2
        assert robot.commands[-1] == Twist()


def test_no_silence_no_stop(guarded):
    robot = guarded({'timeout': 1.0})
    slowest = 0.0
    for _ in range(5):
        began = time.monotonic()
        robot.ask(-0.5)
        robot.spin(0.4)
        slowest = max(slowest, time.monotonic() - began)
    assert len(robot.commands) == 5 or slowest > 0.9
