"""Drive the robot straight on by a distance, in the loop of a generator."""

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
PROGRESS = 0.01  # m: a robot that moves less stands still
PATIENCE = Duration(seconds=1.0)  # how long it may stand still before the goal is aborted


class DistanceDriver(Node):
    """Serve drive_distance."""

    def __init__(self, **kwargs):
        super().__init__('distance_driver', **kwargs)
        self.busy = threading.Lock()
        self.position = None
        self.has_odometry = threading.Event()
        self.server = ActionServer(
            self, DriveDistance, 'drive_distance', self.execute,
            goal_callback=self.accept, cancel_callback=self.accept_cancel,
            callback_group=ReentrantCallbackGroup())
        self.odom = self.create_subscription(Odometry, 'odom', self.odom_callback, 10)
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)

    def destroy_node(self):
        """Destroy the action server, then the node."""
        self.server.destroy()
        super().destroy_node()

    def odom_callback(self, msg):
        self.position = msg.pose.pose.position
        if not self.has_odometry.is_set():
            self.has_odometry.set()
            self.get_logger().info('The odometry is there')

    def accept(self, goal):
        limits = DriveDistance.Goal
        conditions = [
            math.isfinite(goal.distance), math.isfinite(goal.speed),
            goal.distance > 0, goal.distance <= limits.MAX_DISTANCE,
            goal.speed > 0, goal.speed <= limits.MAX_SPEED,
            self.has_odometry.is_set(),
        ]
        accepted = all(conditions) and self.busy.acquire(blocking=False)
        return GoalResponse.ACCEPT if accepted else GoalResponse.REJECT

    def accept_cancel(self, goal_handle):
        return CancelResponse.ACCEPT

    def execute(self, goal_handle):
        result = DriveDistance.Result()
        try:
            self.get_logger().info('Off we go')
            result.driven, result.reason = self.drive(goal_handle)
            if not result.reason:
                goal_handle.succeed()
            elif goal_handle.is_cancel_requested:
                goal_handle.canceled()
            else:
                goal_handle.abort()
            return result
        finally:
            self.busy.release()

    def publish_command(self, speed=0.0):
        command = Twist()
        command.linear.x = speed
        self.publisher.publish(command)

    def progress(self):
        """Yield the distance driven and the time, ten times a second."""
        x, y = self.position.x, self.position.y
        clock = self.get_clock()
        while True:
            yield math.hypot(self.position.x - x, self.position.y - y), clock.now()
            clock.sleep_for(CONTROL_PERIOD, self.context)

    def drive(self, goal_handle):
        goal = goal_handle.request
        best, progress_time = 0.0, self.get_clock().now()
        reason = ''
        for driven, now in self.progress():
            goal_handle.publish_feedback(DriveDistance.Feedback(
                driven=driven, remaining=max(goal.distance - driven, 0.0)))
            if driven >= best + PROGRESS:
                best, progress_time = driven, now
            if driven >= goal.distance:
                break
            if goal_handle.is_cancel_requested:
                reason = 'cancel requested'
                break
            if now >= progress_time + PATIENCE:
                reason = f'stuck after {driven:.2f} m'
                break
            self.publish_command(goal.speed)
        self.publish_command()
        return driven, reason


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = DistanceDriver()
        executor = MultiThreadedExecutor()
        executor.add_node(node)
        while rclpy.ok():  # with several threads, spin() can miss a SIGTERM
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
