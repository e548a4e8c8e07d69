"""The simulator in its own process, as students' nodes meet it: a ROS 2 robot that sends and receives over DDS."""

from __future__ import annotations

import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import DescribeParameters, SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool, Trigger

from sim.recording import load_recording

ROOT = Path(__file__).resolve().parents[2]
WORLDS = ROOT / "assets" / "worlds"
PATIENCE = 60.0  # seconds: a deadline, not an expectation


class Listener:
    """A node that stores received messages and waits for conditions."""

    def __init__(self, context: rclpy.Context) -> None:
        self.node = rclpy.create_node("listener", context=context)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self.node)

    def subscribe(self, kind: Any, topic: str, qos: Any = 10) -> list[Any]:
        """Subscribe to a topic; return the list to which each message is added."""
        received: list[Any] = []
        self.node.create_subscription(kind, topic, received.append, qos)
        return received

    def wait(self, condition: Callable[[], Any], awaited: str) -> None:
        """Spin until the condition is true."""
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, f"timed out waiting for {awaited}"
            self._executor.spin_once(timeout_sec=0.1)

    def call(self, kind: Any, name: str, request: Any) -> Any:
        """Call a service and return its answer."""
        client = self.node.create_client(kind, name)
        self.wait(client.service_is_ready, name)
        future = client.call_async(request)
        self.wait(future.done, f"the answer of {name}")
        return future.result()

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()


@pytest.fixture
def listener(ros_domain: int) -> Iterator[Listener]:
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    listener = Listener(context)
    yield listener
    listener.close()
    context.try_shutdown()


Start = Callable[..., subprocess.Popen[str]]


@pytest.fixture
def simulator() -> Iterator[Start]:
    """Return a function that starts a simulator, which is killed after the test."""
    started: list[subprocess.Popen[str]] = []

    def start(world: str | Path, *parameters: str) -> subprocess.Popen[str]:
        arguments = [text for parameter in (f"world:={world}", *parameters) for text in ("-p", parameter)]
        process = subprocess.Popen(
            [sys.executable, "-m", "sim.bridge", "--ros-args", *arguments],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


def seconds(stamp: Any) -> float:
    return float(stamp.sec + stamp.nanosec * 1e-9)


def test_scans_have_the_fields_and_qos_of_a_lidar_driver(listener: Listener, simulator: Start) -> None:
    scans = listener.subscribe(LaserScan, "/scan", qos_profile_sensor_data)
    clock = listener.subscribe(Clock, "/clock", qos_profile_sensor_data)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    listener.wait(lambda: len(scans) >= 3, "three scans")

    first, second = scans[0], scans[1]
    assert first.header.frame_id == "laser"
    assert len(first.ranges) == len(first.intensities) == 360
    assert first.angle_min == 0.0
    assert first.angle_max == pytest.approx(first.angle_min + 359 * first.angle_increment, abs=1e-5)
    assert (first.range_min, first.range_max) == pytest.approx((0.12, 3.5))
    assert first.scan_time == pytest.approx(0.2)
    assert first.ranges[0] == pytest.approx(3.0)  # the east wall
    assert first.ranges[90] == pytest.approx(2.0)  # the north wall
    assert first.ranges[34] == math.inf  # the corner is farther than the lidar sees
    assert seconds(second.header.stamp) - seconds(first.header.stamp) == pytest.approx(0.2)
    assert seconds(clock[-1].clock) >= seconds(first.header.stamp)

    (publisher,) = listener.node.get_publishers_info_by_topic("/scan")
    assert publisher.node_name == "simulator"
    assert publisher.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    assert publisher.qos_profile.durability == DurabilityPolicy.VOLATILE


def test_a_reliable_subscription_gets_no_scan(listener: Listener, simulator: Start) -> None:
    reliable = listener.subscribe(LaserScan, "/scan", 10)
    scans = listener.subscribe(LaserScan, "/scan", qos_profile_sensor_data)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    listener.wait(lambda: len(scans) >= 3, "three scans")
    assert reliable == []


def test_the_robot_follows_cmd_vel_until_its_watchdog_stops_it(listener: Listener, simulator: Start) -> None:
    odometry = listener.subscribe(Odometry, "/odom")
    publisher = listener.node.create_publisher(Twist, "/cmd_vel", 10)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    listener.wait(lambda: odometry and publisher.get_subscription_count(), "the simulator")
    assert (odometry[0].header.frame_id, odometry[0].child_frame_id) == ("odom", "base_link")
    assert odometry[0].twist.twist.linear.x == 0.0

    command = Twist()
    command.linear.x, command.angular.z = 0.2, 0.5
    publisher.publish(command)
    listener.wait(lambda: odometry[-1].twist.twist.linear.x == pytest.approx(0.2), "the robot to drive")
    listener.wait(lambda: odometry[-1].twist.twist.linear.x == 0.0, "the watchdog to stop it")
    pose = odometry[-1].pose.pose
    assert 0.03 < pose.position.x < 0.2
    assert 0.05 < 2.0 * math.atan2(pose.orientation.z, pose.orientation.w) < 0.5


def test_a_command_that_is_not_finite_is_ignored(listener: Listener, simulator: Start) -> None:
    odometry = listener.subscribe(Odometry, "/odom")
    publisher = listener.node.create_publisher(Twist, "/cmd_vel", 10)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    listener.wait(lambda: odometry and publisher.get_subscription_count(), "the simulator")
    bad, good = Twist(), Twist()
    bad.linear.x, good.angular.z = math.nan, 1.0
    publisher.publish(bad)
    publisher.publish(good)
    listener.wait(lambda: odometry[-1].twist.twist.angular.z == pytest.approx(1.0), "the good command")
    assert all(math.isfinite(message.pose.pose.position.x) for message in odometry)


def test_the_simulator_accepts_twist_stamped_if_its_parameter_says_so(listener: Listener, simulator: Start) -> None:
    odometry = listener.subscribe(Odometry, "/odom")
    publisher = listener.node.create_publisher(TwistStamped, "/cmd_vel", 10)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy", "stamped_cmd_vel:=true")
    listener.wait(lambda: odometry and publisher.get_subscription_count(), "the simulator")
    command = TwistStamped()
    command.twist.linear.x = 0.3
    publisher.publish(command)
    listener.wait(lambda: odometry[-1].twist.twist.linear.x == pytest.approx(0.3), "the robot to drive")


def test_each_of_several_robots_has_its_own_namespace(listener: Listener, simulator: Start) -> None:
    scans = {
        name: listener.subscribe(LaserScan, f"/{name}/scan", qos_profile_sensor_data)
        for name in ("alpha", "beta", "gamma")
    }
    odometry = {name: listener.subscribe(Odometry, f"/{name}/odom") for name in scans}
    publisher = listener.node.create_publisher(Twist, "/beta/cmd_vel", 10)
    simulator(WORLDS / "lab.yaml", "engine:=numpy", "robots:=[alpha, beta, gamma]")
    listener.wait(lambda: all(scans.values()) and all(odometry.values()), "all robots")
    assert {scans[name][0].header.frame_id for name in scans} == {"alpha/laser", "beta/laser", "gamma/laser"}
    assert list(scans["alpha"][0].ranges) != list(scans["beta"][0].ranges)

    listener.wait(publisher.get_subscription_count, "beta's subscription")
    command = Twist()
    command.linear.x = 0.2
    publisher.publish(command)
    listener.wait(lambda: odometry["beta"][-1].twist.twist.linear.x == pytest.approx(0.2), "beta to drive")
    assert odometry["alpha"][-1].pose.pose.position.x == 0.0


def test_time_can_be_paused_stepped_exactly_and_resumed(listener: Listener, simulator: Start) -> None:
    clock = listener.subscribe(Clock, "/clock", 10)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy", "start_paused:=true", "step_time:=0.5")
    for expected in ("paused at 0.500 s", "paused at 1.000 s"):
        assert listener.call(Trigger, "/simulator/step", Trigger.Request()).message == expected
    listener.wait(lambda: clock and seconds(clock[-1].clock) == pytest.approx(1.0), "the clock")

    answer = listener.call(Trigger, "/simulator/reset", Trigger.Request())
    assert (answer.success, answer.message) == (True, "reset at 0.000 s")
    resumed = listener.call(SetBool, "/simulator/pause", SetBool.Request(data=False))
    assert resumed.message.startswith("running at")
    clock.clear()
    listener.wait(lambda: clock and seconds(clock[-1].clock) > 0.5, "time to advance")
    paused = listener.call(SetBool, "/simulator/pause", SetBool.Request(data=True))
    paused_again = listener.call(SetBool, "/simulator/pause", SetBool.Request(data=True))
    assert paused.message == paused_again.message


def test_the_speed_of_time_can_change_while_it_runs(listener: Listener, simulator: Start) -> None:
    clock = listener.subscribe(Clock, "/clock", 10)
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy", "speed:=0.01")
    listener.wait(lambda: len(clock) >= 2, "the clock")
    request = SetParameters.Request(parameters=[Parameter("speed", value=50.0).to_parameter_msg()])
    (result,) = listener.call(SetParameters, "/simulator/set_parameters", request).results
    assert result.successful
    listener.wait(lambda: seconds(clock[-1].clock) > 20.0, "20 s, which at 0.01 would take half an hour")


def test_each_parameter_is_described_and_only_two_can_change(listener: Listener, simulator: Start) -> None:
    simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    request = DescribeParameters.Request(names=["speed", "world", "lidar", "seed"])
    speed, world, lidar, seed = listener.call(DescribeParameters, "/simulator/describe_parameters", request).descriptors
    assert speed.description
    assert (speed.floating_point_range[0].from_value, speed.floating_point_range[0].to_value) == (0.01, 1000.0)
    assert not speed.read_only
    assert world.read_only
    assert "rplidar_a1" in lidar.additional_constraints
    assert seed.integer_range[0].from_value == 0

    for parameter, words in (
        (Parameter("world", value="x.yaml"), "read-only"),
        (Parameter("speed", value=-1.0), "range"),
    ):
        change = SetParameters.Request(parameters=[parameter.to_parameter_msg()])
        (result,) = listener.call(SetParameters, "/simulator/set_parameters", change).results
        assert not result.successful
        assert words in result.reason


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_simulator_ends_cleanly_on_a_signal(listener: Listener, simulator: Start, number: signal.Signals) -> None:
    clock = listener.subscribe(Clock, "/clock", 10)
    process = simulator(WORLDS / "empty_room.yaml", "engine:=numpy")
    listener.wait(lambda: clock, "the clock")
    process.send_signal(number)
    output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, output
    assert "Traceback" not in output


# Runs the simulator and interrupts it while it adds the second row to its recording.
INTERRUPTED = """
import os, signal, sys
from sim import recording
from sim.bridge.node import main
clearance, calls = recording.clearance, []
def interrupted(*arguments):
    calls.append(arguments)
    if len(calls) == 2:
        os.kill(os.getpid(), signal.SIGINT)
    return clearance(*arguments)
recording.clearance = interrupted
sys.exit(main(sys.argv))
"""


def test_a_recording_is_complete_even_if_interrupted_in_the_middle_of_a_row(ros_domain: int, tmp_path: Path) -> None:
    parameters = (f"world:={WORLDS / 'empty_room.yaml'}", "engine:=numpy", f"recording:={tmp_path / 'run.npz'}")
    arguments = [text for parameter in parameters for text in ("-p", parameter)]
    process = subprocess.run(
        [sys.executable, "-c", INTERRUPTED, "--ros-args", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert process.returncode == 0, process.stderr
    recorded = load_recording(tmp_path / "run.npz")
    assert len(recorded.times_ns) == len(recorded.clearances) >= 2


@pytest.mark.parametrize(
    ("world", "parameters", "message"),
    [
        ("nowhere.yaml", (), "nowhere.yaml"),
        ("''", (), "parameter 'world' is empty"),
        (WORLDS / "empty_room.yaml", ("robots:=[a, b]",), "2 robots, but the world 'empty room' has 1 start"),
        (WORLDS / "doorway.yaml", ("robots:=[a, a]",), "names a robot twice"),
        (WORLDS / "empty_room.yaml", ("lidar:=sonar",), "choose one of lds_01, rplidar_a1, utm_30lx"),
        (WORLDS / "empty_room.yaml", ("speed:=-1.0",), "out of range"),
        (WORLDS / "empty_room.yaml", ("seed:=abc",), "seed"),
    ],
)
def test_invalid_settings_are_named(
    simulator: Start, world: str | Path, parameters: tuple[str, ...], message: str
) -> None:
    process = simulator(world, *parameters)
    output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 1, output
    assert message in output
    assert "Traceback" not in output
