"""The guard: a node with a fan."""

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard.core import Fan
from motor_guard.running import run


class Guard(Node):
    """A node that replaces its fan with each average."""

    def __init__(self, **kwargs):
        """Create a fan that is off, and the endpoints."""
        super().__init__('guard', **kwargs)
        self.fan = Fan(**{
            name: self.declare_parameter(name, default).value for name, default in (('hot', 60.0), ('cool', 50.0))})
        self.decisions = self.create_publisher(Decision, 'decision', 10)
        self.create_subscription(Temperature, 'smoothed', self.on_average, 10)

    def on_average(self, average):
        """Replace the fan, and publish its state."""
        self.fan = self.fan.after_temperature(average.celsius)
        decision = Decision()
        decision.stamp, decision.celsius, decision.cooling = average.stamp, average.celsius, self.fan.cooling
        self.decisions.publish(decision)


def main(args=None):
    """Run the node until it is interrupted."""
    run(Guard, args)
