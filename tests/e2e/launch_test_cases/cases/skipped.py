"""A launch that is skipped."""

import unittest

import launch
import launch_testing.actions
import pytest


@pytest.mark.launch_test
@unittest.skip("not today")
def generate_test_description():
    return launch.LaunchDescription([launch_testing.actions.ReadyToTest()])


class TestBeside(unittest.TestCase):
    def test_it(self):
        pass
