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
    """Where a goal is."""

    ROLLING = auto()
    THERE = auto()
    CALLED_OFF = auto()
    STUCK = auto()


REASONS = {State.THERE: "", State.CALLED_OFF: "called off", State.STUCK: "no way forward for a second"}


class Leg:
    """One goal on its way."""

    def __init__(self, distance, start, now):
        """Begin it."""
        self.distance, self.start = distance, start
        self.driven, self.mark, self.since = 0.0, 0.0, now

    def next(self, here, now, cancelled):
        """Return the state after a look at the odometry."""
        self.driven = float(np.linalg.norm(here - self.start))
        if self.driven - self.mark >= 0.01:
            self.mark, self.since = self.driven, now
        if self.driven >= self.distance:
            return State.THERE
        if cancelled:
            return State.CALLED_OFF
        return State.STUCK if now - self.since > Duration(seconds=1.0) else State.ROLLING


class DistanceDriver(Node):
    """The action's server."""

    def __init__(self):
        """Make the ends."""
        super().__init__("distance_driver")
        self.here = None
        self.one_at_a_time = threading.Semaphore(1)
        self.motors = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.hear, 10)
        self.server = ActionServer(
            self,
            DriveDistance,
            "drive_distance",
            self.execute,
            goal_callback=self.consider,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def hear(self, message):
        """Keep the position as an array."""
        if self.here is None:
            self.get_logger().info("The odometry is there")
        point = message.pose.pose.position
        self.here = np.array([point.x, point.y])

    def consider(self, goal):
        """Accept what can be driven."""
        limits = ((goal.distance, goal.MAX_DISTANCE), (goal.speed, goal.MAX_SPEED))
        if self.here is None or not all(0.0 < asked <= most for asked, most in limits):
            return GoalResponse.REJECT
        free = self.one_at_a_time.acquire(blocking=False)
        return GoalResponse.ACCEPT if free else GoalResponse.REJECT

    def execute(self, handle):
        """Tick until the goal is no longer rolling."""
        goal = handle.request
        leg = Leg(goal.distance, self.here, self.get_clock().now())
        try:
            while (state := leg.next(self.here, self.get_clock().now(), handle.is_cancel_requested)) is State.ROLLING:
                handle.publish_feedback(
                    DriveDistance.Feedback(driven=leg.driven, remaining=goal.distance - leg.driven)
                )
                self.motors.publish(Twist(linear=Vector3(x=goal.speed)))
                self.get_clock().sleep_for(Duration(seconds=0.1), self.context)
        finally:
            self.motors.publish(Twist())
            self.one_at_a_time.release()
        ends = {State.THERE: handle.succeed, State.CALLED_OFF: handle.canceled, State.STUCK: handle.abort}
        ends[state]()
        return DriveDistance.Result(driven=leg.driven, reason=REASONS[state])


def main(args=None):
    """Run it in threads."""
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
