"""The distance driver on one thread: a timer drives, and execute only awaits the end."""

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


class Wheels(Node):
    """Drives by a timer; at most one goal is under way."""

    def __init__(self):
        super().__init__("distance_driver")
        self.odometry = None
        self.reserved = False
        self.under_way = None
        self.commands = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_subscription(Odometry, "odom", self.hear, qos_profile_sensor_data)
        self.create_timer(TICK, self.tick)
        ActionServer(
            self,
            DriveDistance,
            "drive_distance",
            self.execute,
            goal_callback=self.judge,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            callback_group=MutuallyExclusiveCallbackGroup(),
        )

    def hear(self, odometry):
        """Keep the odometry."""
        self.odometry = odometry.pose.pose.position

    def judge(self, goal):
        """Accept or reject."""
        inside = 0 < goal.distance <= goal.MAX_DISTANCE and 0 < goal.speed <= goal.MAX_SPEED
        if not inside or self.odometry is None or self.reserved:
            return GoalResponse.REJECT
        self.reserved = True
        return GoalResponse.ACCEPT

    async def execute(self, handle):
        """Hand the goal to the timer, and await its end."""
        self.goal_handle, self.origin = handle, self.odometry
        self.best, self.ticks_without_progress = 0.0, 0
        self.under_way = Future()
        reason = await self.under_way
        self.under_way = None
        self.commands.publish(Twist())
        result = DriveDistance.Result()
        result.driven, result.reason = self.driven(), reason
        self.reserved = False
        {"": handle.succeed, "asked to": handle.canceled}.get(reason, handle.abort)()
        return result

    def driven(self):
        """Return the metres from the start."""
        here = self.odometry
        return math.hypot(here.x - self.origin.x, here.y - self.origin.y)

    def tick(self):
        """Drive on, or end the goal."""
        if self.under_way is None or self.under_way.done():
            return
        goal, driven = self.goal_handle.request, self.driven()
        self.ticks_without_progress += 1
        if driven >= self.best + 0.01:
            self.best, self.ticks_without_progress = driven, 0
        if driven >= goal.distance:
            self.under_way.set_result("")
        elif self.goal_handle.is_cancel_requested:
            self.under_way.set_result("asked to")
        elif self.ticks_without_progress * TICK > 1.0:
            self.under_way.set_result("stuck")
        else:
            self.goal_handle.publish_feedback(DriveDistance.Feedback(driven=driven, remaining=goal.distance - driven))
            command = Twist()
            command.linear.x = goal.speed
            self.commands.publish(command)


def main():
    """Run it."""
    rclpy.init()
    wheels = Wheels()
    try:
        rclpy.spin(wheels)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        wheels.destroy_node()
        rclpy.try_shutdown()
