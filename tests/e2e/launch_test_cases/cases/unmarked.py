"""Without its mark, a file is like any other file of tests for pytest; `launch_test` runs it all the same."""

import unittest

import launch
import launch_testing.actions
import launch_testing.util


def generate_test_description():
    return launch.LaunchDescription([launch_testing.util.KeepAliveProc(), launch_testing.actions.ReadyToTest()])


class TestBeside(unittest.TestCase):
    def test_it(self):
        pass
