"""The guard: a fan in a node."""

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard.core import Fan
from motor_guard.running import run


class Guard(Node):
    """Holds the fan of now."""

    def __init__(self, **kwargs):
        """Begin with a fan that is off."""
        super().__init__('guard', **kwargs)
        self.fan = Fan(**{
            name: self.declare_parameter(name, default).value for name, default in (('hot', 60.0), ('cool', 50.0))})
        self.decisions = self.create_publisher(Decision, 'decision', 10)
        self.create_subscription(Temperature, 'smoothed', self.hear, 10)

    def hear(self, average):
        """Replace the fan, and publish what it does."""
        self.fan = self.fan.at(average.celsius)
        decision = Decision()
        decision.stamp, decision.celsius, decision.cooling = average.stamp, average.celsius, self.fan.cooling
        self.decisions.publish(decision)


def main(args=None):
    """Run it."""
    run(Guard, args)
