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

"""An action that drives the robot straight on, until it has come far enough."""

from dataclasses import dataclass
import math
import threading
from typing import Optional, Tuple

from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time

CONTROL_PERIOD = Duration(seconds=0.1)  # between two commands, and two feedbacks
PROGRESS = 0.01  # m: less than this is standing still
PATIENCE = Duration(seconds=1.0)  # how long it may stand still before the goal is given up


@dataclass
class Watch:
    """Sees whether the robot comes further."""

    progress_time: Time  # when it last came a centimetre further
    furthest: float = 0.0  # m, how far it had come then

    def is_stuck(self, driven: float, now: Time) -> bool:
        """Take note of a distance; return whether the last progress was too long ago."""
        if driven - self.furthest >= PROGRESS:
            self.furthest = driven
            self.progress_time = now
        return now - self.progress_time >= PATIENCE


class DistanceDriver(Node):
    """Serves drive_distance (my_robot_interfaces/DriveDistance), one goal at a time."""

    def __init__(self, **kwargs):
        """Name the node distance_driver; create its publisher, subscription and server."""
        super().__init__('distance_driver', **kwargs)
        self.busy = threading.Lock()  # held while a goal is being driven
        self.position: Optional[Tuple[float, float]] = None
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(
            Odometry, 'odom', self.odom_callback, 10,
            callback_group=MutuallyExclusiveCallbackGroup())
        self.server = ActionServer(
            self, DriveDistance, 'drive_distance', self.execute,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=self.accept,
            cancel_callback=self.accept_cancel)

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        """Keep the newest position; log at level info 'The odometry is there', once."""
        first = self.position is None
        where = msg.pose.pose.position
        self.position = where.x, where.y
        if first:
            self.get_logger().info('The odometry is there')

    def accept(self, goal):
        """Return GoalResponse.ACCEPT for a goal that can be driven now, otherwise REJECT."""
        limits = (
            (goal.distance, DriveDistance.Goal.MAX_DISTANCE),
            (goal.speed, DriveDistance.Goal.MAX_SPEED),
        )
        for value, limit in limits:
            if math.isnan(value) or value <= 0.0 or value > limit:
                return GoalResponse.REJECT
        if self.position is None:
            return GoalResponse.REJECT
        if not self.busy.acquire(blocking=False):
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def accept_cancel(self, goal_handle):
        """Return CancelResponse.ACCEPT: a robot may always be stopped."""
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        """Drive, stop the robot, end the goal and return its Result, whatever happens."""
        result = DriveDistance.Result()
        end = goal_handle.abort
        try:
            end = self.drive(goal_handle, result)
        finally:
            try:
                self.cmd_vel_pub.publish(Twist())
            finally:
                self.busy.release()
        end()
        return result

    def drive(self, goal_handle, result):
        """Drive until the goal is reached or given up; fill the result, return how to end."""
        clock = self.get_clock()
        distance, start = goal_handle.request.distance, self.position
        go = Twist()
        go.linear.x = goal_handle.request.speed
        watch = Watch(clock.now())
        while True:
            result.driven = math.dist(self.position, start)
            if result.driven >= distance:
                return goal_handle.succeed
            if goal_handle.is_cancel_requested:
                result.reason = 'cancelled'
                return goal_handle.canceled
            if watch.is_stuck(result.driven, clock.now()):
                result.reason = 'no progress for a second'
                return goal_handle.abort
            self.cmd_vel_pub.publish(go)
            goal_handle.publish_feedback(DriveDistance.Feedback(
                driven=result.driven, remaining=distance - result.driven))
            if not clock.sleep_for(CONTROL_PERIOD, self.context) and not self.context.ok():
                raise ExternalShutdownException()


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
