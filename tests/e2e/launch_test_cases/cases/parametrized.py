"""A launch for each value, with a launch argument."""

import unittest

import launch
import launch_testing
import launch_testing.actions
import launch_testing.util
import pytest
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


@pytest.mark.launch_test
@launch_testing.parametrize("word, number", [("a", 1), ("b", 2)])
def generate_test_description(word, number):
    echo = ExecuteProcess(cmd=["echo", word, str(number), LaunchConfiguration("more")], name="echo")
    return launch.LaunchDescription(
        [
            DeclareLaunchArgument("more", default_value="nothing", description="What else to say"),
            echo,
            launch_testing.util.KeepAliveProc(),
            launch_testing.actions.ReadyToTest(),
        ]
    ), {"echo": echo}


class TestEach(unittest.TestCase):
    def test_word(self, proc_output, echo, word, number, test_args):
        more = test_args.get("more", "nothing")
        proc_output.assertWaitFor(f"{word} {number} {more}", process=echo, timeout=60, stream="stdout")
        self.assertEqual(word, "a")
