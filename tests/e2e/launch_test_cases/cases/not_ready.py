"""A launch description without ReadyToTest."""

import unittest

import launch
import pytest


@pytest.mark.launch_test
def generate_test_description():
    return launch.LaunchDescription([])


class TestBeside(unittest.TestCase):
    def test_it(self):
        pass
