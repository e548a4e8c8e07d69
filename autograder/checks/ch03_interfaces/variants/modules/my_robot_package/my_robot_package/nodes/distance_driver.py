"""The distance driver as a state machine: each tick of a goal leads from one state to the next."""

from enum import Enum, auto
import threading

from geometry_msgs.msg import Twist, Vector3
from my_robot_interfaces.action import DriveDistance
from nav_msgs.msg import Odometry
import numpy as np
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node


class State(Enum):
    """The state of a goal."""

    DRIVING = auto()
    ARRIVED = auto()
    CANCELED = auto()
    STUCK = auto()


REASONS = {State.ARRIVED: "", State.CANCELED: "called off", State.STUCK: "no way forward for a second"}


class Trip:
    """A goal that is being driven."""

    def __init__(self, distance, start, now):
        """Start a goal at a position and a time."""
        self.distance, self.start = distance, start
        self.driven, self.best, self.progress_time = 0.0, 0.0, now

    def next(self, position, now, cancelled):
        """Return the next state for a position from the odometry."""
        self.driven = float(np.linalg.norm(position - self.start))
        if self.driven - self.best >= 0.01:
            self.best, self.progress_time = self.driven, now
        if self.driven >= self.distance:
            return State.ARRIVED
        if cancelled:
            return State.CANCELED
        return State.STUCK if now - self.progress_time > Duration(seconds=1.0) else State.DRIVING


class DistanceDriver(Node):
    """Serve the action drive_distance."""

    def __init__(self):
        """Create the publisher, the subscription and the action server."""
        super().__init__("distance_driver")
        self.position = None
        self.slot = threading.Semaphore(1)
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.odom_callback, 10)
        self.server = ActionServer(
            self,
            DriveDistance,
            "drive_distance",
            self.execute,
            goal_callback=self.accept,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def odom_callback(self, message):
        """Store the position as an array."""
        if self.position is None:
            self.get_logger().info("The odometry is there")
        point = message.pose.pose.position
        self.position = np.array([point.x, point.y])

    def accept(self, goal):
        """Accept a goal that can be driven, one at a time."""
        limits = ((goal.distance, goal.MAX_DISTANCE), (goal.speed, goal.MAX_SPEED))
        if self.position is None or not all(0.0 < value <= limit for value, limit in limits):
            return GoalResponse.REJECT
        is_free = self.slot.acquire(blocking=False)
        return GoalResponse.ACCEPT if is_free else GoalResponse.REJECT

    def execute(self, handle):
        """Drive until the goal is no longer in the state DRIVING."""
        goal = handle.request
        trip = Trip(goal.distance, self.position, self.get_clock().now())
        try:
            while (state := trip.next(self.position, self.get_clock().now(), handle.is_cancel_requested)) is State.DRIVING:
                handle.publish_feedback(
                    DriveDistance.Feedback(driven=trip.driven, remaining=goal.distance - trip.driven)
                )
                self.commands.publish(Twist(linear=Vector3(x=goal.speed)))
                self.get_clock().sleep_for(Duration(seconds=0.1), self.context)
        finally:
            self.commands.publish(Twist())
            self.slot.release()
        finish = {State.ARRIVED: handle.succeed, State.CANCELED: handle.canceled, State.STUCK: handle.abort}
        finish[state]()
        return DriveDistance.Result(driven=trip.driven, reason=REASONS[state])


def main(args=None):
    """Run the node on several threads."""
    rclpy.init(args=args)
    node = DistanceDriver()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        while rclpy.ok():
            executor.spin_once(timeout_sec=0.5)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.server.destroy()
        node.destroy_node()
        rclpy.try_shutdown()
