"""A timer drives; execute sleeps in its own thread until an event tells that the goal is over."""

import math
import threading
from types import SimpleNamespace

from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class Driver(Node):
    """Has at most one job."""

    def __init__(self):
        """Make the ends; the wheels turn in a group of their own."""
        super().__init__("distance_driver")
        self.position, self.job, self.lock = None, None, threading.RLock()
        self.commands = self.create_publisher(Twist, "cmd_vel", 5)
        wheels = MutuallyExclusiveCallbackGroup()
        self.create_subscription(Odometry, "odom", self.locate, 10, callback_group=MutuallyExclusiveCallbackGroup())
        self.timer = self.create_timer(0.1, self.roll, callback_group=wheels)
        self.timer.cancel()
        self.server = ActionServer(
            self, DriveDistance, "drive_distance", self.execute,
            goal_callback=self.take, handle_accepted_callback=self.begin, cancel_callback=self.let_go,
            callback_group=ReentrantCallbackGroup(),
        )

    def locate(self, odometry):
        """Remember where it is."""
        self.position = odometry.pose.pose.position

    def take(self, goal):
        """Accept one good goal at a time."""
        good = 0.0 < goal.distance <= 5.0 and 0.0 < goal.speed <= 0.5 and self.position is not None
        with self.lock:
            if not good or self.job is not None:
                return GoalResponse.REJECT
            self.job = SimpleNamespace(over=threading.Event(), end=None, driven=0.0, best=0.0, idle=0)
            return GoalResponse.ACCEPT

    def begin(self, handle):
        """Start the wheels at once, and execute beside them."""
        self.job.start, self.job.handle = self.position, handle
        handle.execute()
        self.roll()
        self.timer.reset()

    def let_go(self, handle):
        """Stop whenever somebody asks."""
        return CancelResponse.ACCEPT

    def execute(self, handle):
        """Wait for the end, and say it."""
        job = self.job
        job.over.wait()
        job.end()
        result = DriveDistance.Result(driven=job.driven, reason=job.reason)
        with self.lock:
            self.job = None
        return result

    def roll(self):
        """Drive on for a tick, or end the job."""
        job = self.job
        if job is None or job.over.is_set():
            return
        job.driven = math.hypot(self.position.x - job.start.x, self.position.y - job.start.y)
        job.idle += 1
        if job.driven >= job.best + 0.01:
            job.best, job.idle = job.driven, 1
        goal, command = job.handle.request, Twist()
        if job.driven >= goal.distance:
            job.end, job.reason = job.handle.succeed, ""
        elif job.handle.is_cancel_requested:
            job.end, job.reason = job.handle.canceled, "somebody asked for it"
        elif job.idle > 11:
            job.end, job.reason = job.handle.abort, "stuck"
        else:
            command.linear.x = goal.speed
            job.handle.publish_feedback(
                DriveDistance.Feedback(driven=job.driven, remaining=goal.distance - job.driven))
        self.commands.publish(command)
        if job.end is not None:
            self.timer.cancel()
            job.over.set()


def main():
    """Run it in threads."""
    rclpy.init()
    driver = Driver()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(driver)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        driver.server.destroy()
        driver.destroy_node()
        rclpy.try_shutdown()
