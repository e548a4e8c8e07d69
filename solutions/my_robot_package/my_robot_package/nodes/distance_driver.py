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

"""Serve an action that drives straight on for a given distance and can be cancelled."""

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

CONTROL_PERIOD = Duration(seconds=0.1)  # between two commands, and two feedbacks
PROGRESS = 0.01  # m: less than this is standing still
PATIENCE = Duration(seconds=1.0)  # how long it may stand still before the goal is given up


class DistanceDriver(Node):
    """
    Serves drive_distance (my_robot_interfaces/DriveDistance), one goal at a time.

    Subscribes to odom (nav_msgs/Odometry) and publishes cmd_vel (geometry_msgs/Twist). Run it
    in a MultiThreadedExecutor: while execute drives, odometry and cancel requests must get
    through.
    """

    def __init__(self, **kwargs):
        """
        Name the node distance_driver; create its publisher, subscription and action server.

        cmd_vel and odom: a queue of 10. The action server's callbacks are in a
        ReentrantCallbackGroup, so that they may run at the same time. kwargs are passed on to
        Node, so that a test can pass a context of its own.
        """
        super().__init__('distance_driver', **kwargs)
        self.position = None  # m, (x, y) in the frame of the odometry
        self.busy = threading.Lock()  # held while a goal is being driven
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Odometry, 'odom', self.odom_callback, 10)
        self.server = ActionServer(
            self,
            DriveDistance,
            'drive_distance',
            execute_callback=self.execute,
            goal_callback=self.accept,
            cancel_callback=self.accept_cancel,
            callback_group=ReentrantCallbackGroup(),
        )
        self.get_logger().info('Distance driver initialised')

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        """Keep the newest position; log at level info 'The odometry is there', once."""
        if self.position is None:
            self.get_logger().info('The odometry is there')
        self.position = (msg.pose.pose.position.x, msg.pose.pose.position.y)

    def accept(self, goal):
        """
        Return GoalResponse.ACCEPT for a goal that can be driven now, otherwise REJECT.

        It can be driven when distance is above 0 and at most MAX_DISTANCE, speed is above 0 and
        at most MAX_SPEED (nan fails both), a position is known, and no other goal is being
        driven.
        """
        possible = (
            0.0 < goal.distance <= DriveDistance.Goal.MAX_DISTANCE
            and 0.0 < goal.speed <= DriveDistance.Goal.MAX_SPEED
            and self.position is not None
            and self.busy.acquire(blocking=False)
        )
        return GoalResponse.ACCEPT if possible else GoalResponse.REJECT

    def accept_cancel(self, goal_handle):
        """Return CancelResponse.ACCEPT: a robot may always be stopped."""
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        """
        Drive, stop the robot, end the goal and return its Result, whatever happens.

        Ten times a second: publish feedback and a command, straight on at the goal's speed,
        until the robot is the goal's distance away from where it was at the start of the goal
        (succeed). End early when a cancel is requested (canceled), or when the robot got less
        than PROGRESS further within PATIENCE (abort): it is stuck, or the odometry is silent.
        When the goal ends early, reason says why.
        """
        try:
            driven, reason = self.drive(goal_handle)
        finally:
            self.cmd_vel_pub.publish(Twist())
            self.busy.release()
        if not reason:
            goal_handle.succeed()
        elif goal_handle.is_cancel_requested:
            goal_handle.canceled()
        else:
            goal_handle.abort()
        return DriveDistance.Result(driven=driven, reason=reason)

    def drive(self, goal_handle):
        """Drive until the goal ends, in whatever way; return the metres driven and a reason."""
        goal = goal_handle.request
        start = self.position
        driven, furthest, progress_time = 0.0, 0.0, self.get_clock().now()
        command = Twist()
        command.linear.x = goal.speed
        while driven < goal.distance:
            if goal_handle.is_cancel_requested:
                return driven, 'cancelled'
            if self.get_clock().now() - progress_time > PATIENCE:
                return driven, 'no progress: the robot is stuck, or its odometry is silent'
            goal_handle.publish_feedback(
                DriveDistance.Feedback(driven=driven, remaining=goal.distance - driven))
            self.cmd_vel_pub.publish(command)
            self.get_clock().sleep_for(CONTROL_PERIOD, self.context)
            driven = math.dist(start, self.position)
            if driven >= furthest + PROGRESS:
                furthest, progress_time = driven, self.get_clock().now()
        return driven, ''


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = DistanceDriver()
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok():  # with several threads, spin() without a timeout can miss a SIGTERM
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
