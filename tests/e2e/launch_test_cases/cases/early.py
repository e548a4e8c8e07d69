"""A launch that ends before its tests do."""

import unittest

import launch
import launch_testing.actions
import pytest
from launch.actions import ExecuteProcess


@pytest.mark.launch_test
def generate_test_description():
    broken = ExecuteProcess(cmd=["sh", "-c", "echo last words; exit 4"], name="broken")
    return launch.LaunchDescription([broken, launch_testing.actions.ReadyToTest()])


class TestBeside(unittest.TestCase):
    def test_that_waits(self, proc_output):
        proc_output.assertWaitFor("nothing", timeout=600, stream="stdout")
