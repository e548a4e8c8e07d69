"""Node navigation_controller: drive, turn or stand still, ten times a second."""

from typing import Optional

from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial import steering
from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run

NANOSECONDS = 10**9  # in a second


def nanoseconds(stamp) -> int:
    """Return the time of a builtin_interfaces/Time as one whole number."""
    return stamp.sec * NANOSECONDS + stamp.nanosec


class NavigationController(Node):
    """Obeys the newest clearance, unless that is old, not valid, or the robot is disabled."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('navigation_controller', **kwargs)
        for name, default, lowest, highest, description in (
            ('forward_speed', 0.3, 0.05, 0.5, 'speed on a clear way, m/s'),
            ('turn_speed', 0.8, 0.1, 1.5, 'speed of a turn on the spot, rad/s'),
            ('safety_distance', 0.6, 0.3, 2.0, 'room ahead that the robot needs, m'),
            ('data_timeout', 0.5, 0.2, 2.0, 'age at which a clearance is worth nothing, s'),
        ):
            declare(self, name, default, lowest, highest, description)
        self.clearance: Optional[Clearance] = None
        self.turn = steering.STRAIGHT
        self.enabled = True
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.subscription = self.create_subscription(
            Clearance, 'clearance', self.clearance_callback, 10)
        self.service = self.create_service(SetBool, 'enable', self.enable_callback)
        self.timer = self.create_timer(0.1, self.control)

    def number(self, name: str) -> float:
        """Look a parameter up."""
        return self.get_parameter(name).value

    def clearance_callback(self, clearance: Clearance) -> None:
        """Keep the newest clearance."""
        self.clearance = clearance

    def enable_callback(self, request, response):
        """Let the robot go, or hold it still."""
        self.enabled = request.data
        response.success = True
        response.message = 'enabled' if request.data else 'disabled'
        return response

    def control(self) -> None:
        """Publish the command of this moment."""
        if self.is_blind() or not self.enabled:
            self.publisher.publish(Twist())  # and keep the turn
            return
        self.turn = steering.choose_turn(
            self.clearance, self.number('safety_distance'), self.turn)
        if self.turn == steering.STRAIGHT:
            twist = Twist(linear=Vector3(x=self.number('forward_speed')))
        else:
            twist = Twist(angular=Vector3(z=self.turn * self.number('turn_speed')))
        self.publisher.publish(twist)

    def is_blind(self) -> bool:
        """Tell whether there is no clearance to go by."""
        if self.clearance is None or not self.clearance.valid:
            return True
        age = self.get_clock().now().nanoseconds - nanoseconds(self.clearance.header.stamp)
        return age > round(self.number('data_timeout') * NANOSECONDS)


def main(args=None) -> None:
    """Start the program."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
