"""Tests of the launched guard's parameters and answers, with a fixture that yields."""

from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch.substitutions import PathJoinSubstitution
import launch_pytest
from launch_ros.substitutions import FindPackageShare
import pytest
from rcl_interfaces.srv import GetParameters


@launch_pytest.fixture
def launched(domain):
    """Launch the guard; the test starts immediately."""
    path = PathJoinSubstitution([FindPackageShare('speed_guard'), 'launch', 'guard.launch.py'])
    yield LaunchDescription([
        SetEnvironmentVariable('ROS_DOMAIN_ID', str(domain)),
        IncludeLaunchDescription(path),
        launch_pytest.actions.ReadyToTest(),
    ])


@pytest.mark.launch(fixture=launched)
def test_its_parameters_are_those_of_the_file(robot):
    """The node /speed_guard has the parameters of the file."""
    client = robot.create_client(GetParameters, '/speed_guard/get_parameters')
    robot.until(client.service_is_ready, seconds=10.0)
    future = client.call_async(GetParameters.Request(names=['stop_distance', 'slow_distance']))
    robot.until(future.done)
    stop, slow = (value.double_value for value in future.result().values)
    assert (stop, slow) == (0.3, 0.8)


@pytest.mark.launch(fixture=launched)
def test_it_limits_the_speed(robot):
    """Half-way between the two distances, the speed is halved."""
    robot.meet(seconds=10.0)
    answers = [robot.see(0.55) or robot.ask(1.0).linear.x for _ in range(20)]
    assert max(answers) == pytest.approx(0.5)
