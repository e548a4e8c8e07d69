"""Tests during the launch and after its end, with all arguments that a test can have."""

import sys
import unittest

import launch
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import pytest
from launch.actions import ExecuteProcess

COUNT = """
import time
print('starting\\nnumber 0\\nnumber 1\\nnumber 2\\nnumber 3', flush=True)
try:
    time.sleep(600)
except KeyboardInterrupt:
    print('interrupted', flush=True)
"""


@pytest.mark.launch_test
def generate_test_description():
    counter = ExecuteProcess(cmd=[sys.executable, "-c", COUNT, "--loud"], name="counter")
    warner = ExecuteProcess(cmd=["sh", "-c", "echo '\x1b[31mhot\x1b[0m' >&2"], name="warner")
    description = launch.LaunchDescription([counter, warner, launch_testing.actions.ReadyToTest()])
    return description, {"counter": counter, "ten": 10}


class TestBeside(unittest.TestCase):
    @classmethod
    def setUpClass(cls, ten):
        cls.ten = ten

    def setUp(self, proc_output):
        self.output = proc_output

    def test_arguments(self, counter, ten, proc_info, test_args, launch_service):
        self.assertEqual((ten, self.ten), (10, 10))
        self.assertEqual(test_args, {})
        self.assertIsNotNone(launch_service.context)
        proc_info.assertWaitForStartup(counter, timeout=60)
        proc_info.assertWaitForShutdown("warner", timeout=60)

    def test_output(self, counter):
        self.output.assertWaitFor("number 3", process=counter, timeout=60, stream="stdout")
        self.output.assertWaitFor("number 3", process="counter", cmd_args="--loud", timeout=60, stream="stdout")
        self.output.assertWaitFor("hot", timeout=60)
        self.assertFalse(self.output.waitFor("nothing", process=counter, timeout=0.1, stream="stdout"))

    @unittest.skip("later")
    def test_skipped(self):
        pass


@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit_codes(self, proc_info, counter):
        launch_testing.asserts.assertExitCodes(proc_info)
        launch_testing.asserts.assertExitCodes(proc_info, [launch_testing.asserts.EXIT_OK], process=counter)
        self.assertEqual(proc_info[counter].returncode, 0)
        self.assertEqual(sorted(name.split("-")[0] for name in proc_info.process_names()), ["counter", "warner"])

    def test_order(self, proc_output, counter):
        with launch_testing.asserts.assertSequentialStdout(proc_output, counter) as checker:
            checker.assertInStdout("starting")
            for number in range(4):
                checker.assertInStdout(f"number {number}")
            checker.assertInStdout("interrupted")

    def test_texts(self, proc_output, counter):
        launch_testing.asserts.assertInStdout(proc_output, "number 2", counter)
        launch_testing.asserts.assertInStderr(proc_output, "hot", "warner")
        launch_testing.asserts.assertInStdout(proc_output, ["starting", "number 1", "interrupted"], "counter")
