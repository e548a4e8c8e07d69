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

"""Pass velocity commands on, slowed down where something is near."""

from geometry_msgs.msg import Twist
import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import Range

from speed_guard.limits import safe_speed

WATCH_PERIOD = 0.05  # s between two looks at how old the newest command is


class SpeedGuard(Node):
    """
    Sits between a planner and the motors.

    Subscribes to cmd_vel_raw (geometry_msgs/Twist, queue of 10) and distance
    (sensor_msgs/Range, qos_profile_sensor_data), publishes cmd_vel (geometry_msgs/Twist,
    queue of 10).

    Each command is answered with exactly one command: linear.x becomes the safe_speed for
    the newest distance, and all other fields stay as they are. A distance is not known
    before the first one has come, and no longer known when it came more than timeout
    seconds ago.

    When no command has come for more than timeout seconds, one command of zeros is
    published: one only, until the next command comes. There is none before the first.

    Parameters: stop_distance (0.5 m), slow_distance (1.5 m), timeout (0.5 s).
    """

    def __init__(self, **kwargs):
        """Name the node speed_guard; kwargs are passed on to Node."""
        super().__init__('speed_guard', **kwargs)
        self.stop_distance = self.declare_parameter('stop_distance', 0.5).value
        self.slow_distance = self.declare_parameter('slow_distance', 1.5).value
        self.timeout = Duration(seconds=self.declare_parameter('timeout', 0.5).value)
        self.distance = None
        self.distance_time = self.get_clock().now()
        self.command_time = None
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Range, 'distance', self.on_distance, qos_profile_sensor_data)
        self.create_subscription(Twist, 'cmd_vel_raw', self.on_command, 10)
        self.create_timer(WATCH_PERIOD, self.watch)

    def on_distance(self, msg):
        """Remember the distance and when it came."""
        self.distance = msg.range
        self.distance_time = self.get_clock().now()

    def on_command(self, msg):
        """Answer a command with one that is safe."""
        self.command_time = self.get_clock().now()
        fresh = self.command_time - self.distance_time <= self.timeout
        msg.linear.x = safe_speed(
            msg.linear.x,
            self.distance if fresh else None,
            self.stop_distance,
            self.slow_distance,
        )
        self.publisher.publish(msg)

    def watch(self):
        """Stop the motors, once, when the planner has fallen silent."""
        if self.command_time is None:
            return
        if self.get_clock().now() - self.command_time > self.timeout:
            self.command_time = None
            self.publisher.publish(Twist())


def main(args=None):
    """Run the node until SIGINT (Ctrl-C) or SIGTERM, then end with exit status 0."""
    rclpy.init(args=args)
    node = None
    try:
        node = SpeedGuard()
        rclpy.spin(node)
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
