"""The odometry lives in a node of its own; execute is a generator that is drained."""

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


class GaveUp(Exception):
    """The goal ends early."""


class DistanceDriver(Node):
    """Drives."""

    def __init__(self):
        """Connect."""
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
        """Keep x and y."""
        where = message.pose.pose.position
        self.position = where.x, where.y

    def accept(self, goal):
        """Reject first what is out of range, then what comes too early, then what comes too often."""
        for value, most in ((goal.distance, goal.MAX_DISTANCE), (goal.speed, goal.MAX_SPEED)):
            if math.isnan(value) or value <= 0.0 or value > most:
                return GoalResponse.REJECT
        if not self.position or not self.busy.acquire(blocking=False):
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def accept_cancel(self, handle):
        """Always."""
        return CancelResponse.ACCEPT

    def steps(self, handle, result):
        """Yield a command for each tenth of a second; raise GaveUp where it ends early."""
        start, distance = self.position, handle.request.distance
        moved_at, moved = self.get_clock().now(), 0.0
        while True:
            result.driven = math.dist(start, self.position)
            if result.driven >= distance:
                return
            if handle.is_cancel_requested:
                raise GaveUp("cancelled")
            if result.driven >= moved + 0.01:
                moved_at, moved = self.get_clock().now(), result.driven
            if self.get_clock().now() - moved_at > Duration(seconds=1):
                raise GaveUp("it does not move")
            feedback = DriveDistance.Feedback()
            feedback.driven, feedback.remaining = result.driven, distance - result.driven
            handle.publish_feedback(feedback)
            command = Twist()
            command.linear.x = handle.request.speed
            yield command

    def execute(self, handle):
        """Publish what `steps` yields."""
        result = DriveDistance.Result()
        try:
            for command in self.steps(handle, result):
                self.cmd_vel.publish(command)
                self.get_clock().sleep_for(TENTH, self.context)
        except GaveUp as reason:
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
    """Spin in a pool of threads."""
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
