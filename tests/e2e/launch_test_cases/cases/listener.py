"""A launch that is ready once a process prints a text."""

import sys
import unittest

import launch
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.event_handlers
import launch_testing.markers
import pytest
from launch.actions import ExecuteProcess, RegisterEventHandler

SERVE = """
import signal
signal.signal(signal.SIGINT, signal.SIG_DFL)
print('waking up\\nserving', flush=True)
signal.pause()
"""
attempts = []


@pytest.mark.launch_test
def generate_test_description():
    server = ExecuteProcess(cmd=[sys.executable, "-c", SERVE], name="server")
    on_output = launch_testing.event_handlers.StdoutReadyListener(
        target_action=server, ready_txt="serving", actions=[launch_testing.actions.ReadyToTest()]
    )
    return launch.LaunchDescription([RegisterEventHandler(on_output), server])


class TestBeside(unittest.TestCase):
    def test_it_was_heard(self, proc_output):
        proc_output.assertWaitFor("serving", timeout=60, stream="stdout")

    @launch_testing.markers.retry_on_failure(times=3)
    def test_that_fails_twice(self):
        attempts.append(1)
        self.assertEqual(len(attempts), 3)


@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit_code(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info, [-2])
