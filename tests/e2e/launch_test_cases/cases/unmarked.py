"""A launch test without the mark, which is an ordinary file of tests for pytest but not for `launch_test`."""

import unittest

import launch
import launch_testing.actions
import launch_testing.util


def generate_test_description():
    return launch.LaunchDescription([launch_testing.util.KeepAliveProc(), launch_testing.actions.ReadyToTest()])


class TestBeside(unittest.TestCase):
    def test_it(self):
        pass
