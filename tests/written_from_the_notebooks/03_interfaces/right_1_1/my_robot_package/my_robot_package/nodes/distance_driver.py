# Copyright 2026 The ROS 2 Python Course Authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""An action that drives the robot straight on by a distance."""

import math
import threading

from geometry_msgs.msg import Twist, Vector3
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

CONTROL_PERIOD = Duration(seconds=0.1)
PROGRESS = 0.01  # m
PATIENCE = Duration(seconds=1.0)


class Progress:
    """Tells whether something still gets further."""

    def __init__(self, now):
        self.furthest = 0.0
        self.progress_time = now

    def is_stuck(self, driven, now):
        """Take note of how far it is now; say whether the last centimetre is too long ago."""
        if driven >= self.furthest + PROGRESS:
            self.furthest, self.progress_time = driven, now
        return now - self.progress_time > PATIENCE


class DistanceDriver(Node):
    """Serves drive_distance, listens to odom, publishes cmd_vel."""

    def __init__(self, **kwargs):
        """Name the node; create its endpoints."""
        super().__init__('distance_driver', **kwargs)
        self.busy = threading.Lock()
        self.position = None
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.server = ActionServer(
            self, DriveDistance, 'drive_distance', self.execute,
            callback_group=ReentrantCallbackGroup(),
            cancel_callback=self.accept_cancel,
            goal_callback=self.accept)
        self.create_subscription(Odometry, 'odom', self.odom_callback, 10)

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        """Keep where the robot is; say once that the odometry is there."""
        here = msg.pose.pose.position
        self.position = here.x, here.y
        self.get_logger().info('The odometry is there', once=True)

    def accept(self, goal):
        """Accept what can be driven now."""
        limits = DriveDistance.Goal
        for value, most in ((goal.distance, limits.MAX_DISTANCE), (goal.speed, limits.MAX_SPEED)):
            if math.isnan(value) or value <= 0.0 or value > most:
                return GoalResponse.REJECT
        if self.position is None:
            return GoalResponse.REJECT
        if self.busy.acquire(blocking=False):
            return GoalResponse.ACCEPT
        return GoalResponse.REJECT

    def accept_cancel(self, goal_handle):
        """Allow it: a robot may be stopped at any time."""
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        """Drive until there is a reason to end, stop, and end the goal."""
        try:
            end, result = self.drive(goal_handle)
        finally:
            self.send(0.0)
            self.busy.release()
        end()
        return result

    def send(self, speed):
        """Publish a command."""
        self.cmd_vel_pub.publish(Twist(linear=Vector3(x=speed)))

    def drive(self, goal_handle):
        """Drive; return how the goal is to be ended, and its result."""
        wanted, speed = goal_handle.request.distance, goal_handle.request.speed
        start = self.position
        progress = Progress(self.get_clock().now())
        while True:
            driven = math.dist(self.position, start)
            if driven >= wanted:
                return goal_handle.succeed, DriveDistance.Result(driven=driven)
            if goal_handle.is_cancel_requested:
                return goal_handle.canceled, DriveDistance.Result(
                    driven=driven, reason='cancelled')
            if progress.is_stuck(driven, self.get_clock().now()):
                return goal_handle.abort, DriveDistance.Result(
                    driven=driven, reason='no progress for 1 s')
            goal_handle.publish_feedback(
                DriveDistance.Feedback(driven=driven, remaining=wanted - driven))
            self.send(speed)
            self.get_clock().sleep_for(CONTROL_PERIOD, self.context)


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = DistanceDriver()
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok():  # with several threads, a spin without end can miss a SIGTERM
            executor.spin_once(timeout_sec=1.0)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RuntimeError:
        if rclpy.ok():  # if not, a signal came between two waits, and rclpy raised this
            raise
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
