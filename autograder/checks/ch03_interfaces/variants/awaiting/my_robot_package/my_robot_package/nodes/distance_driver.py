"""The distance driver on one thread: a timer drives, and execute awaits the end of the goal."""

import math

from geometry_msgs.msg import Twist
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.task import Future

TICK = 0.1


class DistanceDriver(Node):
    """Drive by a timer, at most one goal at a time."""

    def __init__(self):
        super().__init__("distance_driver")
        self.position = None
        self.reserved = False
        self.goal_future = None
        self.commands = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Odometry, "odom", self.odom_callback, qos_profile_sensor_data)
        self.create_timer(TICK, self.tick)
        ActionServer(
            self,
            DriveDistance,
            "drive_distance",
            self.execute,
            goal_callback=self.accept,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=MutuallyExclusiveCallbackGroup(),
        )

    def odom_callback(self, odometry):
        """Store the position from the odometry."""
        self.position = odometry.pose.pose.position

    def accept(self, goal):
        """Accept or reject a goal."""
        is_valid = 0 < goal.distance <= goal.MAX_DISTANCE and 0 < goal.speed <= goal.MAX_SPEED
        if not is_valid or self.position is None or self.reserved:
            return GoalResponse.REJECT
        self.reserved = True
        return GoalResponse.ACCEPT

    async def execute(self, handle):
        """Pass the goal to the timer, and await its end."""
        self.goal_handle, self.origin = handle, self.position
        self.best, self.ticks_without_progress = 0.0, 0
        self.goal_future = Future()
        reason = await self.goal_future
        self.goal_future = None
        self.commands.publish(Twist())
        result = DriveDistance.Result()
        result.driven, result.reason = self.driven(), reason
        self.reserved = False
        {"": handle.succeed, "asked to": handle.canceled}.get(reason, handle.abort)()
        return result

    def driven(self):
        """Return the distance from the start in metres."""
        position = self.position
        return math.hypot(position.x - self.origin.x, position.y - self.origin.y)

    def tick(self):
        """Drive on, or end the goal."""
        if self.goal_future is None or self.goal_future.done():
            return
        goal, driven = self.goal_handle.request, self.driven()
        self.ticks_without_progress += 1
        if driven >= self.best + 0.01:
            self.best, self.ticks_without_progress = driven, 0
        if driven >= goal.distance:
            self.goal_future.set_result("")
        elif self.goal_handle.is_cancel_requested:
            self.goal_future.set_result("asked to")
        elif self.ticks_without_progress * TICK > 1.0:
            self.goal_future.set_result("stuck")
        else:
            self.goal_handle.publish_feedback(DriveDistance.Feedback(driven=driven, remaining=goal.distance - driven))
            command = Twist()
            command.linear.x = goal.speed
            self.commands.publish(command)


def main():
    """Run the node."""
    rclpy.init()
    node = DistanceDriver()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
