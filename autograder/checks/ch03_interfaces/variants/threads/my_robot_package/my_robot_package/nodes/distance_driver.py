"""The distance driver with a generator of commands, which execute publishes."""

import math
import threading

from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

TENTH = Duration(seconds=0.1)


class GoalEnded(Exception):
    """The goal ends early."""


class DistanceDriver(Node):
    """Serve drive_distance."""

    def __init__(self):
        """Create the publisher, the subscription and the action server."""
        super().__init__("distance_driver")
        self.position = ()
        self.busy = threading.Lock()
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odometry, 10)
        self.server = ActionServer(
            self, DriveDistance, "drive_distance", execute_callback=self.execute, goal_callback=self.accept,
            cancel_callback=self.accept_cancel, callback_group=ReentrantCallbackGroup(),
        )

    def on_odometry(self, message):
        """Store x and y."""
        position = message.pose.pose.position
        self.position = position.x, position.y

    def accept(self, goal):
        """Reject goals that are out of range, too early, or sent during another goal."""
        for value, limit in ((goal.distance, goal.MAX_DISTANCE), (goal.speed, goal.MAX_SPEED)):
            if math.isnan(value) or value <= 0.0 or value > limit:
                return GoalResponse.REJECT
        if not self.position or not self.busy.acquire(blocking=False):
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def accept_cancel(self, handle):
        """Accept every cancel."""
        return CancelResponse.ACCEPT

    def commands_of(self, handle, result):
        """Yield a command for each tenth of a second; raise GoalEnded if the goal ends early."""
        start, distance = self.position, handle.request.distance
        progress_time, progress = self.get_clock().now(), 0.0
        while True:
            result.driven = math.dist(start, self.position)
            if result.driven >= distance:
                return
            if handle.is_cancel_requested:
                raise GoalEnded("cancelled")
            if result.driven >= progress + 0.01:
                progress_time, progress = self.get_clock().now(), result.driven
            if self.get_clock().now() - progress_time > Duration(seconds=1):
                raise GoalEnded("it does not move")
            feedback = DriveDistance.Feedback()
            feedback.driven, feedback.remaining = result.driven, distance - result.driven
            handle.publish_feedback(feedback)
            command = Twist()
            command.linear.x = handle.request.speed
            yield command

    def execute(self, handle):
        """Publish the commands of the goal, and return its result."""
        result = DriveDistance.Result()
        try:
            for command in self.commands_of(handle, result):
                self.cmd_vel.publish(command)
                self.get_clock().sleep_for(TENTH, self.context)
        except GoalEnded as reason:
            result.reason = str(reason)
        finally:
            self.cmd_vel.publish(Twist())
            self.busy.release()
        if not result.reason:
            handle.succeed()
        elif handle.is_cancel_requested:
            handle.canceled()
        else:
            handle.abort()
        return result


def main():
    """Run the node on several threads."""
    rclpy.init()
    node = DistanceDriver()
    executor = MultiThreadedExecutor()
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.server.destroy()
        node.destroy_node()
        rclpy.try_shutdown()
