"""A timer drives; execute waits in its own thread for an event at the end of the goal."""

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
    """Drive at most one goal at a time."""

    def __init__(self):
        """Create the topics, the action server, and the timer in its own callback group."""
        super().__init__("distance_driver")
        self.position, self.job, self.lock = None, None, threading.RLock()
        self.commands = self.create_publisher(Twist, "cmd_vel", 5)
        timer_group = MutuallyExclusiveCallbackGroup()
        self.create_subscription(Odometry, "odom", self.odom_callback, 10, callback_group=MutuallyExclusiveCallbackGroup())
        self.timer = self.create_timer(0.1, self.drive, callback_group=timer_group)
        self.timer.cancel()
        self.server = ActionServer(
            self, DriveDistance, "drive_distance", self.execute,
            goal_callback=self.accept, handle_accepted_callback=self.start, cancel_callback=self.accept_cancel,
            callback_group=ReentrantCallbackGroup(),
        )

    def odom_callback(self, odometry):
        """Store the robot's position."""
        self.position = odometry.pose.pose.position

    def accept(self, goal):
        """Accept one valid goal at a time."""
        is_valid = 0.0 < goal.distance <= 5.0 and 0.0 < goal.speed <= 0.5 and self.position is not None
        with self.lock:
            if not is_valid or self.job is not None:
                return GoalResponse.REJECT
            self.job = SimpleNamespace(done=threading.Event(), finish=None, driven=0.0, best=0.0, idle_ticks=0)
            return GoalResponse.ACCEPT

    def start(self, handle):
        """Start the timer and execute the goal."""
        self.job.start, self.job.handle = self.position, handle
        handle.execute()
        self.drive()
        self.timer.reset()

    def accept_cancel(self, handle):
        """Accept every cancel."""
        return CancelResponse.ACCEPT

    def execute(self, handle):
        """Wait for the end of the goal, and return its result."""
        job = self.job
        job.done.wait()
        job.finish()
        result = DriveDistance.Result(driven=job.driven, reason=job.reason)
        with self.lock:
            self.job = None
        return result

    def drive(self):
        """Drive on for a tick, or end the goal."""
        job = self.job
        if job is None or job.done.is_set():
            return
        job.driven = math.hypot(self.position.x - job.start.x, self.position.y - job.start.y)
        job.idle_ticks += 1
        if job.driven >= job.best + 0.01:
            job.best, job.idle_ticks = job.driven, 1
        goal, command = job.handle.request, Twist()
        if job.driven >= goal.distance:
            job.finish, job.reason = job.handle.succeed, ""
        elif job.handle.is_cancel_requested:
            job.finish, job.reason = job.handle.canceled, "somebody asked for it"
        elif job.idle_ticks > 11:
            job.finish, job.reason = job.handle.abort, "stuck"
        else:
            command.linear.x = goal.speed
            job.handle.publish_feedback(
                DriveDistance.Feedback(driven=job.driven, remaining=goal.distance - job.driven))
        self.commands.publish(command)
        if job.finish is not None:
            self.timer.cancel()
            job.done.set()


def main():
    """Run the node on several threads."""
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
