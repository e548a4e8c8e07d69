"""The node that drives, more slowly where there is less room."""

from geometry_msgs.msg import Twist
from rclpy.node import Node
from robot_navigation_interfaces.msg import Clearance
from std_srvs.srv import SetBool

from robot_navigation_tutorial.parameters import declare
from robot_navigation_tutorial.running import run
from robot_navigation_tutorial.steering import choose_turn, STRAIGHT

CONTROL_PERIOD = 0.1
PARAMETERS = (
    ('forward_speed', 0.3, 0.05, 0.5, 'm/s when nothing is near'),
    ('turn_speed', 0.8, 0.1, 1.5, 'rad/s'),
    ('safety_distance', 0.6, 0.3, 2.0, 'm: nearer things start a turn'),
    ('data_timeout', 0.5, 0.2, 2.0, 's: older clearances are not trusted'),
)


def nanoseconds(stamp):
    """Return a stamp in nanoseconds."""
    return stamp.sec * 10**9 + stamp.nanosec


class NavigationController(Node):
    """Drives, turns or stands still."""

    def __init__(self, **kwargs):
        """Create the node."""
        super().__init__('navigation_controller', **kwargs)
        for parameter in PARAMETERS:
            declare(self, *parameter)
        self.newest, self.enabled, self.turn = None, True, STRAIGHT
        self.publisher = self.create_publisher(Twist, 'cmd_vel', 10)
        self.create_subscription(Clearance, 'clearance', self.clearance_callback, 10)
        self.create_service(SetBool, 'enable', self.enable_callback)
        self.create_timer(CONTROL_PERIOD, self.control)

    def __getitem__(self, name):
        """Return the value of a parameter."""
        return self.get_parameter(name).value

    def clearance_callback(self, clearance):
        """Remember the newest clearance."""
        self.newest = clearance

    def enable_callback(self, request, response):
        """Let the robot move, or hold it still."""
        if self.enabled != request.data:
            self.get_logger().info('enabled' if request.data else 'disabled')
        self.enabled = request.data
        response.success = True
        response.message = 'it may move' if request.data else 'it is held'
        return response

    def control(self):
        """Publish exactly one command."""
        self.publisher.publish(self.command())

    def command(self):
        """Return the command of this moment."""
        command = Twist()
        if not (self.enabled and self.is_trusted(self.newest)):
            return command
        safe = self['safety_distance']
        self.turn = choose_turn(self.newest, safe, self.turn)
        if self.turn == STRAIGHT:
            share = min(max((self.newest.front - safe) / 0.5, 0.3), 1.0)
            command.linear.x = share * self['forward_speed']
        else:
            command.angular.z = 0.9 * self.turn * self['turn_speed']
        return command

    def is_trusted(self, clearance):
        """Return whether there is a clearance, it is valid, and it is not too old."""
        if clearance is None or not clearance.valid:
            return False
        age = self.get_clock().now().nanoseconds - nanoseconds(clearance.header.stamp)
        return age <= self['data_timeout'] * 1e9


def main(args=None):
    """Run the node until it is told to stop."""
    run(NavigationController, args)


if __name__ == '__main__':
    main()
