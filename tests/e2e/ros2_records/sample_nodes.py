"""The nodes for the tests of `ros2`: a talker, and a helper with a service, parameters and an action.

The script prints `ready` once its nodes are up, and ends on SIGINT or SIGTERM.
"""

from __future__ import annotations

import signal
import threading
from typing import Any

import rclpy
from example_interfaces.action import Fibonacci
from geometry_msgs.msg import Twist
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import LaserScan
from std_msgs.msg import String
from std_srvs.srv import SetBool


class Talker(Node):
    def __init__(self) -> None:
        super().__init__("talker")
        self.count = 0
        self.chatter = self.create_publisher(String, "chatter", 10)
        self.scan = self.create_publisher(LaserScan, "scan", 10)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_publisher(String, "robot_description", latched).publish(String(data="a robot"))
        self.create_publisher(String, "_hidden", 10)
        self.create_timer(0.05, self.talk)

    def talk(self) -> None:
        self.count += 1
        self.chatter.publish(String(data=f"hello {self.count}"))
        self.scan.publish(LaserScan(ranges=[1.0] * 200, range_max=8.0))


class Helper(Node):
    def __init__(self) -> None:
        super().__init__("helper", namespace="/lab")
        self.ending = threading.Event()
        limits = FloatingPointRange(from_value=0.0, to_value=2.0, step=0.5)
        self.declare_parameter(
            "speed", 1.0, ParameterDescriptor(description="How fast, in m/s", floating_point_range=[limits])
        )
        self.declare_parameter("ids", [1, 2, 3])
        self.declare_parameter("filter.window", 5)
        self.declare_parameter("frozen", "yes", ParameterDescriptor(read_only=True))
        self.declare_parameter("anything", "old", ParameterDescriptor(dynamic_typing=True))
        self.add_on_set_parameters_callback(self.validate)
        self.create_subscription(Twist, "cmd_vel", lambda _: None, 10)
        self.create_service(SetBool, "switch", self.switch)
        self.server = ActionServer(
            self,
            Fibonacci,
            "count",
            self.execute,
            goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def validate(self, parameters: list[Parameter]) -> SetParametersResult:
        invalid = [p.name for p in parameters if p.name == "filter.window" and p.value % 2 == 0]
        return SetParametersResult(successful=not invalid, reason="the window must be odd" if invalid else "")

    def switch(self, request: Any, response: Any) -> Any:
        response.success, response.message = True, f"switched {'on' if request.data else 'off'}"
        return response

    def execute(self, goal: Any) -> Any:
        """Compute the Fibonacci numbers up to the order; a goal above 100 never ends."""
        numbers = [0, 1]
        while len(numbers) <= goal.request.order:
            # Slow enough for feedback to arrive before the result.
            self.ending.wait(0.1)
            numbers.append(numbers[-1] + numbers[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            while goal.request.order > 100 and not goal.is_cancel_requested and not self.ending.wait(0.01):
                pass
            if self.ending.is_set():
                goal.abort()
                return Fibonacci.Result()
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=numbers)
        goal.succeed()
        return Fibonacci.Result(sequence=numbers)


def main() -> None:
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    executor = MultiThreadedExecutor(4)
    talker, helper = Talker(), Helper()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: helper.ending.set())
    for node in (talker, helper):
        executor.add_node(node)
    print("ready", flush=True)
    # Spin on the main thread: another thread that still spins when the interpreter exits would abort the program.
    while not helper.ending.is_set():
        executor.spin_once(timeout_sec=0.1)
    executor.shutdown()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main()
