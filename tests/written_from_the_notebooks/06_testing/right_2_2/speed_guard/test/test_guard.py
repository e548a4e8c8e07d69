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

"""A planner, a sensor and motors find out what stands between them."""

import itertools
import math

from geometry_msgs.msg import Twist, Vector3
from pytest import approx, mark

CALM = 60.0  # s: with this timeout, only the order of the messages counts
QUICK = 0.15  # s


def tell(robot, distance):
    """Publish a distance, and give the guard the time to take it in."""
    robot.see(distance)
    robot.spin(0.05)


def numbers(command):
    """Return the six numbers of a command."""
    return [
        getattr(vector, axis) for vector in (command.linear, command.angular) for axis in 'xyz']


class TestAnswers:
    """What becomes of a command."""

    def test_whose_they_are(self, robot, start):
        """Exactly speed_guard is there, besides the robot."""
        start()
        robot.until(lambda: 'speed_guard' in robot.get_node_names())
        assert ('speed_guard', '/') in robot.get_node_names_and_namespaces()

    def test_without_any_distance(self, robot, start):
        """Blind: backwards only."""
        start(timeout=CALM)
        answers = [robot.ask(speed).linear.x for speed in (2.0, 0.1, 0.0, -0.1, -2.0)]
        assert answers == approx([0.0, 0.0, 0.0, -0.1, -2.0])

    def test_with_one_distance_after_the_other(self, robot, start):
        """The last word of the sensor counts, whether it is better or worse than before."""
        start(timeout=CALM)
        script = [
            (0.75, 0.25), (0.25, 0.0), (1.0, 0.5), (math.nan, 0.0), (8.0, 1.0), (1.25, 0.75),
            (math.inf, 1.0), (0.5, 0.0), (1.5, 1.0),
        ]
        answers = []
        for distance, _ in script:
            tell(robot, distance)
            answers.append(robot.ask(1.0).linear.x)
        assert answers == approx([speed for _, speed in script])

    @mark.parametrize('distance', [None, 0.25, 1.0, 8.0])
    def test_all_but_the_first_number_stay(self, robot, start, distance):
        """Each of the five others in turn, in whatever way the first one changes."""
        start(timeout=CALM)
        if distance is not None:
            tell(robot, distance)
        for speed, place in itertools.product((1.0, -1.0), range(1, 6)):
            sent = [speed, 0.0, 0.0, 0.0, 0.0, 0.0]
            sent[place] = 0.5 * speed
            robot.commands.clear()
            robot.planner.publish(
                Twist(linear=Vector3(**dict(zip('xyz', sent[:3]))),
                      angular=Vector3(**dict(zip('xyz', sent[3:])))))
            robot.until(lambda: robot.commands)
            assert numbers(robot.commands[0])[1:] == approx(sent[1:])

    def test_one_for_one(self, robot, start):
        """No command is swallowed, none comes twice, and a distance makes none."""
        start(timeout=CALM)
        for round_number in range(1, 5):
            tell(robot, 0.25 * round_number)
            robot.ask(1.0)
            robot.ask(-1.0)
            robot.spin(0.1)
            assert len(robot.commands) == 2 * round_number

    @mark.parametrize(('stop', 'slow', 'distance', 'speed'), [
        (2.0, 4.0, 1.75, 0.0), (2.0, 4.0, 2.5, 0.25), (2.0, 4.0, 3.5, 0.75), (2.0, 4.0, 5.0, 1.0),
        (0.0, 0.5, 0.125, 0.25), (0.5, 8.5, 2.5, 0.25), (1.0, 1.5, 1.25, 0.5),
    ])
    def test_other_limits(self, robot, start, stop, slow, distance, speed):
        """Whoever starts the guard chooses both distances."""
        start(timeout=CALM, stop_distance=stop, slow_distance=slow)
        tell(robot, distance)
        assert robot.ask(1.0).linear.x == approx(speed)


class TestTime:
    """What becomes of silence."""

    @staticmethod
    def best(robot, pause):
        """Return the best of ten answers, each so many seconds after a distance of 1 m."""
        speeds = []
        while len(speeds) < 10 and 0.5 not in [approx(speed) for speed in speeds]:
            robot.see(1.0)
            robot.spin(pause)
            speeds.append(robot.ask(1.0).linear.x)
        return max(speeds)

    def test_the_defaults(self, robot, start):
        """From 0.5 m to 1.5 m, 0.5 is in the middle; 0.5 s is between 0.2 s and 0.7 s."""
        start()
        assert self.best(robot, 0.2) == approx(0.5)
        robot.see(1.0)
        robot.spin(0.7)
        assert robot.ask(1.0).linear.x == 0.0

    def test_the_default_limits(self, robot, start):
        """The middle could be that of another line, but these two points could not."""
        start(timeout=CALM)
        for distance, speed in ((0.75, 0.25), (1.25, 0.75)):
            tell(robot, distance)
            assert robot.ask(1.0).linear.x == approx(speed)

    def test_a_distance_from_long_ago(self, robot, start):
        """It is worth nothing, however far it was, until there is another one."""
        start(timeout=1.0)
        tell(robot, 8.0)
        robot.spin(1.2)
        assert robot.ask(1.0).linear.x == 0.0
        assert robot.ask(-1.0).linear.x == approx(-1.0)
        assert self.best(robot, 0.1) == approx(0.5)

    def test_questions_do_not_make_it_newer(self, robot, start):
        """A planner that never rests is stopped all the same."""
        start(timeout=0.4)
        tell(robot, 8.0)
        robot.until(lambda: robot.ask(1.0).linear.x == 0.0, seconds=1.2)

    def test_silence_from_the_beginning(self, robot, start):
        """Nobody has ordered anything, so there is nothing to stop."""
        start(timeout=QUICK)
        robot.see(8.0)
        robot.spin(4 * QUICK)
        robot.see(8.0)
        robot.spin(4 * QUICK)
        assert not robot.commands

    @mark.parametrize('speed', [1.0, -1.0])
    def test_silence_after_a_command(self, robot, start, speed):
        """One command, in which all is zero; and so again after the next command."""
        start(timeout=QUICK)
        for _ in range(3):
            robot.commands.clear()
            robot.ask(speed, turn=0.5, side=-0.5)
            robot.until(lambda: len(robot.commands) > 1, seconds=1.5)
            robot.spin(4 * QUICK)
            assert [numbers(command) for command in robot.commands[1:]] == [[0.0] * 6]

    def test_a_short_pause_is_no_silence(self, robot, start):
        """Only a pause of more than the timeout is one, counted from the newest command."""
        start(timeout=1.6)
        for count in (1, 2, 3):
            robot.ask(-1.0)
            robot.spin(0.6)
            assert len(robot.commands) == count
        robot.until(lambda: len(robot.commands) == 4, seconds=2.0)
