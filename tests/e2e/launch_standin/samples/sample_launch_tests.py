"""Integration tests of `fleet`, as a student writes them. Another test runs them and checks the reports."""

import launch_pytest
import pytest
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_pytest import tools
from launch_ros.actions import Node
from launch_testing.util import KeepAliveProc


def contains(expected):
    """Return a validator that asserts that the output contains a text."""

    def validate(text):
        assert expected in text

    return validate


def node(executable, **more):
    return Node(package="fleet", executable=executable, cached_output=True, output="screen", **more)


@pytest.fixture
def beacon():
    return node("beacon", name="tested", parameters=[{"label": "under test"}])


@launch_pytest.fixture
def launched(beacon):
    return LaunchDescription([beacon, launch_pytest.actions.ReadyToTest()])


@pytest.mark.launch(fixture=launched)
def test_plain(beacon, launch_context):
    assert tools.wait_for_start_sync(launch_context, beacon, timeout=60)
    tools.assert_output_sync(launch_context, beacon, contains("ready: /tested"), timeout=60)
    assert beacon.return_code is None


@pytest.mark.launch(fixture=launched)
async def test_coroutine(beacon, launch_context):
    await tools.assert_output(launch_context, beacon, contains("label='under test'"), timeout=60)


@pytest.mark.launch(fixture=launched)
def test_generator(beacon, launch_context):
    assert tools.wait_for_output_sync(launch_context, beacon, lambda text: "ready" in text, timeout=60)
    yield
    assert beacon.return_code == 0


@pytest.mark.launch(fixture=launched)
async def test_async_generator(beacon, launch_context):
    assert await tools.wait_for_output(launch_context, beacon, lambda text: "ready" in text, timeout=60)
    yield
    assert beacon.return_code == 0


@pytest.mark.launch(fixture=launched)
def test_that_fails_during_the_launch(beacon, launch_context):
    tools.assert_output_sync(launch_context, beacon, contains("something else"), timeout=0.1)


@pytest.mark.launch(fixture=launched)
def test_that_fails_after_the_end(beacon, launch_context):
    assert tools.wait_for_output_sync(launch_context, beacon, lambda text: "ready" in text, timeout=60)
    yield
    assert beacon.return_code == 5


@pytest.fixture
def crash():
    return node("crash")


@launch_pytest.fixture
def crashing(crash):
    return LaunchDescription([crash, KeepAliveProc()])


@pytest.mark.launch(fixture=crashing)
async def test_of_an_exit(crash, launch_context):
    assert await tools.wait_for_exit(launch_context, crash, timeout=60)
    assert crash.return_code == 3
    await tools.assert_stderr(launch_context, crash, contains("about to crash"), timeout=60)
    assert not await tools.wait_for_stderr(launch_context, crash, lambda text: "fine" in text, timeout=0.01)


@pytest.mark.launch(fixture=crashing)
def test_of_an_exit_in_plain_python(crash, launch_context, launch_service, event_loop):
    assert tools.wait_for_exit_sync(launch_context, crash, timeout=60)
    tools.assert_stderr_sync(launch_context, crash, contains("crash"), timeout=60)
    assert not tools.wait_for_stderr_sync(launch_context, crash, lambda text: "fine" in text, timeout=0.01)
    assert launch_service.event_loop is event_loop


shared = node("light")


@launch_pytest.fixture(scope="module")
def for_all():
    return LaunchDescription([shared]), "more than the description"


@pytest.mark.launch(fixture=for_all, shutdown=True)
def test_after_the_end_of_all():
    assert shared.return_code == 0


@pytest.mark.launch(fixture=for_all)
def test_first_of_all(launch_context, for_all):
    assert tools.wait_for_output_sync(launch_context, shared, lambda text: "light" in text, timeout=60)
    assert for_all[1] == "more than the description"


@pytest.mark.launch(fixture=for_all)
def test_second_of_all():
    assert shared.return_code is None


@launch_pytest.fixture
def broken():
    return LaunchDescription([Node(package="no_such_package", executable="x")])


@pytest.mark.launch(fixture=broken)
def test_of_a_launch_that_fails():
    pass


@launch_pytest.fixture
def wrong():
    return "no launch description"


@pytest.mark.launch(fixture=wrong)
def test_of_a_fixture_that_returns_something_else():
    pass


@launch_pytest.fixture
def twice():
    return LaunchDescription([launch_pytest.actions.ReadyToTest(), launch_pytest.actions.ReadyToTest()])


@pytest.mark.launch(fixture=twice)
def test_of_a_launch_that_is_ready_twice():
    pass


@launch_pytest.fixture(auto_shutdown=False)
def by_itself():
    return LaunchDescription([ExecuteProcess(cmd=["sleep", "0.1"], cached_output=True)])


@pytest.mark.launch(fixture=by_itself)
def test_of_a_launch_that_ends_by_itself():
    yield


def test_without_a_launch():
    assert shared is not None


def test_that_asks_for_a_launch_it_does_not_have(launch_context):
    assert launch_context
