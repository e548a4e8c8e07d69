"""The node `simulator`: one or more robots with the ROS topics of a lidar driver and a motor driver.

Simulated time passes `speed` times as fast as real time. It is counted in whole ticks, so the messages depend on the
commands and the seed, and not on the times at which the timer fires.
"""

from __future__ import annotations

import signal
import time
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.exceptions import ParameterException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock as ClockMessage
from sensor_msgs.msg import LaserScan
from std_srvs.srv import SetBool, Trigger

from sim.bridge.driver import Driver, TickOutput
from sim.bridge.messages import clock_to_msg, odom_to_msg, scan_to_msg, twist_to_command
from sim.bridge.pace import PERIOD, Pace
from sim.bridge.settings import declare, simulation_of
from sim.exceptions import SimError
from sim.recording import Recorder

RECORD_NS = 50_000_000
"""Simulated time between two states of a recording, in ns. A state with an event or a scan is always recorded."""

CLOCK_QOS = QoSProfile(depth=1, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.RELIABLE)
"""Reliable, to match every subscription. The depth is one, because only the newest time is useful."""

RELIABLE_QOS = QoSProfile(depth=5, history=HistoryPolicy.KEEP_LAST, reliability=ReliabilityPolicy.RELIABLE)
"""The lidar's profile, but reliable, to match subscriptions of both kinds."""


class SimulatorNode(Node):
    """Publishes `scan`, `odom` and `/clock`, subscribes to `cmd_vel`, and lets services control time.

    The services are `~/pause`, `~/step` and `~/reset`. Frames, a map and the true pose are optional: see
    `sim.bridge.localization`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("simulator", **kwargs)
        values = declare(self)
        self._driver = Driver(simulation_of(values), odometry_rate=values["odometry_rate"])
        self._driver.warm_up()
        self._speed = float(values["speed"])
        self._step_time = float(values["step_time"])
        self._paused = bool(values["start_paused"])
        self._pace = Pace(self._driver.simulation.tick)
        self._recording = values["recording"]
        self._recorder = self._new_recorder()

        self._clock_publisher = self.create_publisher(ClockMessage, "/clock", CLOCK_QOS)
        self._scan_publishers: dict[str, Any] = {}
        self._odometry_publishers: dict[str, Any] = {}
        twist = TwistStamped if values["stamped_cmd_vel"] else Twist
        scan_qos = RELIABLE_QOS if values["scan_qos"] == "reliable" else qos_profile_sensor_data
        for spec in self._driver.simulation.robots:
            prefix = f"{spec.namespace}/" if spec.namespace else ""
            self._scan_publishers[spec.name] = self.create_publisher(LaserScan, f"{prefix}scan", scan_qos)
            self._odometry_publishers[spec.name] = self.create_publisher(Odometry, f"{prefix}odom", 10)
            self.create_subscription(twist, f"{prefix}cmd_vel", self._command_callback(spec.name), 10)
        self._prefixes = {
            spec.name: f"{spec.namespace}/" if spec.namespace else "" for spec in self._driver.simulation.robots
        }
        self._localization: Any = None
        if values["tf"] != "none" or values["publish_map"] or values["ground_truth"]:
            from sim.bridge.localization import Localization  # needs tf2_msgs, which most runs do not use

            self._localization = Localization(self, self._driver.simulation, self._prefixes, values)

        self.create_service(SetBool, "~/pause", self._on_pause)
        self.create_service(Trigger, "~/step", self._on_step)
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.add_post_set_parameters_callback(self._on_parameters)
        self.create_timer(PERIOD, self._on_timer, clock=Clock(clock_type=ClockType.STEADY_TIME))
        world = self._driver.simulation.world
        self.get_logger().info(f"world {world.name!r}, {len(self._scan_publishers)} robot(s), speed {self._speed:g}")

    @property
    def driver(self) -> Driver:
        """The run, which may be inspected but not stepped."""
        return self._driver

    @property
    def paused(self) -> bool:
        """Whether simulated time is stopped."""
        return self._paused

    def _command_callback(self, robot: str) -> Any:
        def on_command(message: Any) -> None:
            try:
                self._driver.command(robot, twist_to_command(message))
            except ValueError as error:
                self.get_logger().warning(f"{robot}: {error}", throttle_duration_sec=1.0)

        return on_command

    def _on_timer(self) -> None:
        ticks = self._driver.ticks(self._pace.due(time.monotonic(), self._speed, self._paused))
        if self._paused:
            return
        if self._pace.is_late:
            self.get_logger().warning("this machine can't keep up: lower 'speed'", throttle_duration_sec=5.0)
        self._pace.count_simulated(ticks * self._driver.simulation.tick)
        self._advance(ticks)

    def _advance(self, ticks: int) -> None:
        for output in self._driver.run(ticks):
            self._publish(output)
            self._record(output)

    def _new_recorder(self) -> Recorder | None:
        self._recorded_ns = self._driver.state.time_ns
        return Recorder(self._driver.simulation, self._driver.state) if self._recording else None

    def _record(self, output: TickOutput) -> None:
        state, is_due = output.state, output.state.time_ns - self._recorded_ns >= RECORD_NS
        if self._recorder is not None and (is_due or state.events or output.scans):
            self._recorder.append(state)
            for robot, scan in output.scans.items():
                self._recorder.scan(scan, robot)
            self._recorded_ns = state.time_ns

    def destroy_node(self) -> None:
        """Write the recording, if there is one, and destroy the node."""
        if self._recorder is not None:
            self._recorder.recording().save(self._recording)
            self._recorder = None
        super().destroy_node()

    def _publish(self, output: TickOutput) -> None:
        """Send the clock first, so that subscribers never receive data with a stamp in the future."""
        time_ns = output.state.time_ns
        self._clock_publisher.publish(clock_to_msg(time_ns))
        if self._localization is not None:  # before the scans, which need the frames
            self._localization.publish(output.state, output.odometry, output.scans)
        for robot in output.state.robots:
            prefix = self._prefixes[robot.name]
            if robot.name in output.odometry:
                self._odometry_publishers[robot.name].publish(
                    odom_to_msg(robot, time_ns, f"{prefix}odom", f"{prefix}base_link")
                )
            scan = output.scans.get(robot.name)
            if scan is not None:
                self._scan_publishers[robot.name].publish(scan_to_msg(scan, f"{prefix}{scan.frame_id}"))
        for event in output.state.events:
            text = f"{event.robot}: {event.kind}, {event.what}"
            if event.kind == "collision":  # a robot that keeps pushing collides in each tick
                self.get_logger().warning(text, throttle_duration_sec=1.0)
            else:
                self.get_logger().warning(text)

    def pause(self, paused: bool) -> None:
        """Stop simulated time, or continue it."""
        self._paused = paused

    def step(self, seconds: float) -> None:
        """Pause, and simulate `seconds`, at least one tick."""
        self._paused = True
        self._advance(max(1, self._driver.ticks(seconds)))

    def reset(self) -> None:
        """Return to the start."""
        self._driver.reset()
        self._pace.clear()
        self._recorder = self._new_recorder()

    def _on_pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        self.pause(request.data)
        return self._answer(response, "paused" if self._paused else "running")

    def _on_step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.step(self._step_time)
        return self._answer(response, "paused")

    def _on_reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.reset()
        return self._answer(response, "reset")

    def _answer(self, response: Any, status: str) -> Any:
        response.success = True
        response.message = f"{status} at {self._driver.state.time_ns / 1e9:.3f} s"
        return response

    def _on_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "speed":
                self._speed = float(parameter.value)
            elif parameter.name == "step_time":
                self._step_time = float(parameter.value)


def main(args: list[str] | None = None) -> int:
    """Run the node until Ctrl-C or SIGTERM; return 0, or 1 if the settings are invalid.

    It handles the signals itself, and ends between two callbacks. rclpy's handler would shut the context down during a
    callback, and a publisher would raise an RCLError. A KeyboardInterrupt in a callback could leave half a row in the
    recording.
    """
    rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    received_signals: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _: received_signals.append(number))
    node = None
    try:
        node = SimulatorNode()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while not received_signals:
            executor.spin_once(timeout_sec=PERIOD)
    except (SimError, ParameterException) as error:
        rclpy.logging.get_logger("simulator").fatal(str(error))
        return 1
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0
