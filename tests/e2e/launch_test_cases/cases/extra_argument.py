"""A function with a parameter that gets no value."""

import launch
import launch_testing
import launch_testing.actions
import pytest


@pytest.mark.launch_test
@launch_testing.parametrize("word", ["a"])
def generate_test_description(word, other):
    return launch.LaunchDescription([launch_testing.actions.ReadyToTest()])
