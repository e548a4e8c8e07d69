"""A launch that ends before its tests do."""

import unittest
from pathlib import Path

import launch
import launch_testing.actions
import pytest
from launch.actions import ExecuteProcess


@pytest.mark.launch_test
def generate_test_description():
    command = "until [ -e begun ]; do sleep 0.1; done; echo last words; exit 4"
    broken = ExecuteProcess(cmd=["sh", "-c", command], name="broken")
    return launch.LaunchDescription([broken, launch_testing.actions.ReadyToTest()])


class TestBeside(unittest.TestCase):
    def test_that_waits(self, proc_output):
        Path("begun").touch()
        proc_output.assertWaitFor("nothing", timeout=600, stream="stdout")
