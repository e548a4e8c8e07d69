"""Drive the robot straight on by a distance: a loop as a generator."""

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
    """Serves drive_distance."""

    def __init__(self, **kwargs):
        super().__init__('distance_driver', **kwargs)
        self.busy = threading.Lock()
        self.newest = None
        self.first = threading.Event()
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
        self.newest = msg.pose.pose.position
        if not self.first.is_set():
            self.first.set()
            self.get_logger().info('The odometry is there')

    def accept(self, goal):
        limits = DriveDistance.Goal
        good = [
            math.isfinite(goal.distance), math.isfinite(goal.speed),
            goal.distance > 0, goal.distance <= limits.MAX_DISTANCE,
            goal.speed > 0, goal.speed <= limits.MAX_SPEED,
            self.first.is_set(),
        ]
        accepted = all(good) and self.busy.acquire(blocking=False)
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

    def go(self, metres_a_second=0.0):
        command = Twist()
        command.linear.x = metres_a_second
        self.publisher.publish(command)

    def ways(self):
        """Yield (driven, clock) ten times a second."""
        x, y = self.newest.x, self.newest.y
        clock = self.get_clock()
        while True:
            yield math.hypot(self.newest.x - x, self.newest.y - y), clock.now()
            clock.sleep_for(CONTROL_PERIOD, self.context)

    def drive(self, goal_handle):
        goal = goal_handle.request
        best, since = 0.0, self.get_clock().now()
        reason = ''
        for driven, now in self.ways():
            goal_handle.publish_feedback(DriveDistance.Feedback(
                driven=driven, remaining=max(goal.distance - driven, 0.0)))
            if driven >= best + PROGRESS:
                best, since = driven, now
            if driven >= goal.distance:
                break
            if goal_handle.is_cancel_requested:
                reason = 'cancel requested'
                break
            if now >= since + PATIENCE:
                reason = f'stuck after {driven:.2f} m'
                break
            self.go(goal.speed)
        self.go()
        return driven, reason


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
