"""Each kind of failure, with its words."""

import re
import unittest

import launch
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.markers
import launch_testing.util
import pytest
from launch.actions import ExecuteProcess


@pytest.mark.launch_test
@launch_testing.markers.keep_alive
def generate_test_description():
    echo = ExecuteProcess(cmd=["echo", "hello", "world"], name="echo")
    other = ExecuteProcess(cmd=["echo", "other"], name="echo_too")
    broken = ExecuteProcess(cmd=["sh", "-c", "exit 3"], name="broken")
    never = ExecuteProcess(cmd=["echo", "never"], name="never")
    ready = launch_testing.actions.ReadyToTest()
    return launch.LaunchDescription([echo, other, broken, ready]), {"echo": echo, "never": never}


class TestBeside(unittest.TestCase):
    def test_a_text_that_does_not_come(self, proc_output, proc_info, echo):
        proc_info.assertWaitForShutdown(echo, timeout=60)
        proc_output.assertWaitFor("nothing", process=echo, timeout=0.1, stream="stdout")

    def test_no_such_process(self, proc_output):
        proc_output.assertWaitFor("nothing", process="nobody", timeout=0.1, stream="stdout")

    def test_a_process_that_does_not_start(self, proc_info):
        proc_info.assertWaitForStartup("nobody", timeout=0.1)

    def test_a_process_that_does_not_end(self, proc_info):
        proc_info.assertWaitForShutdown("nobody", timeout=0.1)

    def test_an_error(self):
        raise RuntimeError("broken")

    @unittest.expectedFailure
    def test_expected_failure(self):
        self.fail("as expected")


@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit_codes(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)

    def test_exit_codes_of_one(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info, [3], process="broken")

    def test_exit_codes_of_another_kind(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info, ["0"])

    def test_a_name_of_two(self, proc_output):
        launch_testing.asserts.assertInStdout(proc_output, "hello", "echo")

    def test_a_name_of_two_not_strict(self, proc_output):
        launch_testing.asserts.assertInStdout(proc_output, "hello", "echo", strict_proc_matching=False)

    def test_arguments(self, proc_output):
        launch_testing.asserts.assertInStdout(proc_output, "hello", "echo", ["hello", "world"])
        launch_testing.asserts.assertInStdout(proc_output, "hello", "echo", launch_testing.asserts.NO_CMD_ARGS)

    def test_a_text(self, proc_output, echo):
        launch_testing.asserts.assertInStdout(proc_output, "bye", echo)

    def test_a_pattern(self, proc_output, echo):
        launch_testing.asserts.assertInStdout(proc_output, re.compile("w.r"), echo)
        launch_testing.asserts.assertInStdout(proc_output, [re.compile("h.*w"), "hello"], echo)

    def test_a_filter(self, proc_output, echo):
        launch_testing.asserts.assertInStdout(proc_output, "HELLO", echo, output_filter=str.upper)
        launch_testing.asserts.assertInStdout(proc_output, "HELLO", echo, output_filter="upper")

    def test_a_stream(self, proc_output, echo):
        launch_testing.asserts.assertInStream(proc_output, "hello", echo, stream="stdin")

    def test_a_text_of_no_kind(self, proc_output, echo):
        launch_testing.asserts.assertInStdout(proc_output, 5, echo)

    def test_a_process_of_no_kind(self, proc_output):
        launch_testing.asserts.assertInStdout(proc_output, "hello", 5)

    def test_a_process_that_was_not_launched(self, proc_output, never):
        launch_testing.asserts.assertInStdout(proc_output, "hello", never)

    def test_a_missing_name(self, proc_info):
        launch_testing.util.resolveProcesses(proc_info, process="nobody")

    def test_order(self, proc_output, echo):
        with launch_testing.asserts.assertSequentialStdout(proc_output, echo) as checker:
            checker.assertInStdout("world")
            checker.assertInStdout("hello")

    def test_an_argument_that_nobody_gives(self, nothing):
        pass
