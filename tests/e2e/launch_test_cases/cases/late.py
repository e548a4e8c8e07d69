"""A launch that is not ready in time."""

import unittest

import launch
import launch_testing
import launch_testing.actions
import pytest
from launch.actions import TimerAction


@pytest.mark.launch_test
@launch_testing.ready_to_test_action_timeout(0.2)
def generate_test_description():
    return launch.LaunchDescription([TimerAction(period=600.0, actions=[launch_testing.actions.ReadyToTest()])])


class TestBeside(unittest.TestCase):
    def test_it(self):
        pass
