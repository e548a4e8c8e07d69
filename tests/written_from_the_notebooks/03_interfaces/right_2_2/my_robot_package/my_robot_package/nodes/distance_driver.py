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

"""Drive a distance, tell how it goes on, and stop when that is wanted or needed."""

import contextlib
from math import hypot
from threading import Lock

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

Goal, Result, Feedback = DriveDistance.Goal, DriveDistance.Result, DriveDistance.Feedback


class GivenUp(Exception):
    """The goal cannot be reached."""


class Cancelled(Exception):
    """The goal is no longer wanted."""


class DistanceDriver(Node):
    """One goal at a time: so many metres, straight on."""

    def __init__(self, **kwargs):
        """Name the node distance_driver; create its publisher, subscription and server."""
        super().__init__('distance_driver', **kwargs)
        together = ReentrantCallbackGroup()
        self.busy = Lock()
        self.position = None
        self.motor = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(
            Odometry, 'odom', self.odom_callback, 10, callback_group=together)
        self.server = ActionServer(
            node=self,
            action_type=DriveDistance,
            action_name='drive_distance',
            execute_callback=self.execute,
            callback_group=together,
            goal_callback=self.accept,
            cancel_callback=self.accept_cancel,
        )

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        """Keep the newest position; log at level info 'The odometry is there', once."""
        self.position = (msg.pose.pose.position.x, msg.pose.pose.position.y)
        self.get_logger().info('The odometry is there', once=True)

    def accept(self, goal):
        """Return GoalResponse.ACCEPT for a goal that can be driven now, otherwise REJECT."""
        good = 0 < goal.distance <= Goal.MAX_DISTANCE and 0 < goal.speed <= Goal.MAX_SPEED
        if good and self.position and self.busy.acquire(blocking=False):
            return GoalResponse.ACCEPT
        return GoalResponse.REJECT

    def accept_cancel(self, goal_handle):
        """Return CancelResponse.ACCEPT: a robot may always be stopped."""
        return CancelResponse.ACCEPT

    @contextlib.contextmanager
    def _robot(self):
        """Have the robot for a goal: it stands still at the end, and is free for another."""
        try:
            yield
        finally:
            with contextlib.ExitStack() as stack:
                stack.callback(self.busy.release)
                self.motor.publish(Twist())

    def execute(self, goal_handle):
        """Drive, stop the robot, end the goal and return its Result, whatever happens."""
        result = Result()
        try:
            with self._robot():
                for result.driven in self._drive(goal_handle):
                    pass
        except Cancelled:
            result.reason = f'somebody cancelled it after {result.driven:.2f} m'
            goal_handle.canceled()
        except GivenUp as error:
            result.reason = str(error)
            goal_handle.abort()
        else:
            goal_handle.succeed()
        return result

    def _drive(self, goal_handle):
        """Yield how far the robot has come, ten times a second, until it is there."""
        goal = goal_handle.request
        clock = self.get_clock()
        x, y = self.position
        furthest, progress_time = 0.0, clock.now()
        while True:
            now = clock.now()
            newest_x, newest_y = self.position
            driven = hypot(newest_x - x, newest_y - y)
            yield driven
            if driven >= goal.distance:
                return
            if driven >= furthest + PROGRESS:
                furthest, progress_time = driven, now
            if goal_handle.is_cancel_requested:
                raise Cancelled
            if now - progress_time > PATIENCE:
                raise GivenUp('stuck, or the odometry is silent: less than 1 cm in 1 s')
            self.motor.publish(Twist(linear=Vector3(x=goal.speed)))
            goal_handle.publish_feedback(
                Feedback(driven=driven, remaining=goal.distance - driven))
            clock.sleep_for(CONTROL_PERIOD, self.context)


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
