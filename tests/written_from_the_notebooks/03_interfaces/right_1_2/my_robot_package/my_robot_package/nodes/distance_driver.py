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

"""Straight on by a distance, as an action server: the way is a generator, execute uses it."""

from contextlib import contextmanager
from math import hypot
from threading import Lock

from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node

CONTROL_PERIOD = Duration(nanoseconds=100_000_000)
PROGRESS = 0.01  # m
PATIENCE = Duration(seconds=1)


def within(value, most):
    """Say whether a value is in (0, most]."""
    return value > 0.0 and value <= most


class DistanceDriver(Node):
    """A node with one action, drive_distance, for one goal at a time."""

    def __init__(self, **kwargs):
        """Name the node distance_driver; create what it needs."""
        super().__init__('distance_driver', **kwargs)
        group = ReentrantCallbackGroup()
        self.busy = Lock()
        self.position = None
        self.create_subscription(
            Odometry, 'odom', self.odom_callback, 10, callback_group=group)
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.server = ActionServer(
            node=self, action_type=DriveDistance, action_name='drive_distance',
            execute_callback=self.execute, callback_group=group,
            goal_callback=self.accept, cancel_callback=self.accept_cancel)

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        """Keep the newest position."""
        first = self.position is None
        self.position = (msg.pose.pose.position.x, msg.pose.pose.position.y)
        if first:
            self.get_logger().info('The odometry is there')

    def accept(self, goal):
        """Accept a goal that can be driven now."""
        most = DriveDistance.Goal
        if not (within(goal.distance, most.MAX_DISTANCE) and within(goal.speed, most.MAX_SPEED)):
            self.get_logger().warning('Rejected: too far, too fast, or not forward')
        elif self.position is None:
            self.get_logger().warning('Rejected: no odometry yet')
        elif not self.busy.acquire(blocking=False):
            self.get_logger().warning('Rejected: busy')
        else:
            return GoalResponse.ACCEPT
        return GoalResponse.REJECT

    def accept_cancel(self, goal_handle):
        """Accept it always."""
        self.get_logger().info('Somebody wants to cancel')
        return CancelResponse.ACCEPT

    @contextmanager
    def wheels(self):
        """Lend out the wheels: stop them at the end, and let the next goal have them."""
        try:
            yield self.cmd_vel_pub
        finally:
            self.cmd_vel_pub.publish(Twist())
            self.busy.release()

    def way(self):
        """Yield how far the robot has come from here, ten times a second."""
        x, y = self.position
        while True:
            here = self.position
            yield hypot(here[0] - x, here[1] - y)
            self.get_clock().sleep_for(CONTROL_PERIOD, self.context)

    def execute(self, goal_handle):
        """Drive, stop and end the goal."""
        goal = goal_handle.request
        result = DriveDistance.Result()
        command = Twist()
        command.linear.x = goal.speed
        finish = goal_handle.succeed
        with self.wheels() as wheels:
            furthest, progress_time = 0.0, self.get_clock().now()
            for result.driven in self.way():
                if result.driven >= furthest + PROGRESS:
                    furthest, progress_time = result.driven, self.get_clock().now()
                if result.driven >= goal.distance:
                    break
                if goal_handle.is_cancel_requested:
                    finish, result.reason = goal_handle.canceled, 'a client has cancelled it'
                    break
                if self.get_clock().now() > progress_time + PATIENCE:
                    finish, result.reason = goal_handle.abort, 'stuck, or the odometry is silent'
                    break
                wheels.publish(command)
                goal_handle.publish_feedback(DriveDistance.Feedback(
                    driven=result.driven, remaining=goal.distance - result.driven))
        finish()
        return result


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
