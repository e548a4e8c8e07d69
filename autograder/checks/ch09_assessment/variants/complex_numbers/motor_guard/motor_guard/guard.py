"""The guard with a method for each state of the fan, which returns the next state."""
import math

from motor_guard_interfaces.msg import Decision, Temperature
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from motor_guard.running import run


class ThresholdError(Exception):
    """The two thresholds are in the wrong order."""


class Guard(Node):

    def __init__(self, **kwargs):
        super().__init__('guard', **kwargs)
        for name, default in (('cool', 50.0), ('hot', 60.0)):
            self.declare_parameter(
                name, default, ParameterDescriptor(description='degrees', read_only=True))
        self.hot = self.get_parameter('hot').get_parameter_value().double_value
        self.cool = self.get_parameter('cool').get_parameter_value().double_value
        if math.isnan(self.hot) or math.isnan(self.cool) or self.cool >= self.hot:
            raise ThresholdError(f'cool = {self.cool} must be less than hot = {self.hot}')
        self.state = self.off
        self.pub = self.create_publisher(Decision, 'decision', 10)
        self.sub = self.create_subscription(Temperature, 'smoothed', self.decide, 10)

    def off(self, celsius):
        return self.on if celsius >= self.hot else self.off

    def on(self, celsius):
        return self.off if celsius <= self.cool else self.on

    def decide(self, average):
        is_known = math.isfinite(average.celsius)
        self.state = self.state(average.celsius) if is_known else self.on
        if not is_known:
            self.get_logger().error('no temperature: the fan runs')
        decision = Decision(stamp=average.stamp, celsius=average.celsius)
        decision.cooling = self.state == self.on
        self.pub.publish(decision)


def main(args=None):
    run(Guard, args)


if __name__ == '__main__':
    main()
