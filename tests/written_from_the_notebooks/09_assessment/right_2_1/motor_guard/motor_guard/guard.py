"""Node guard: switches the fan."""

from math import isfinite

from motor_guard_interfaces.msg import Decision, Temperature
from rclpy.node import Node

from motor_guard.running import run


class Guard(Node):
    """Hears smoothed, publishes on decision."""

    def __init__(self, **kwargs) -> None:
        """Set the node up; kwargs are those of Node."""
        super().__init__('guard', **kwargs)
        self.declare_parameters('', [('hot', 60.0), ('cool', 50.0)])
        self.hot, self.cool = (
            self.get_parameter(name).value for name in ('hot', 'cool'))
        if self.cool < self.hot:
            self.cooling = False
        else:
            raise RuntimeError(f'cool ({self.cool}) is not less than hot ({self.hot})')
        self.publisher = self.create_publisher(Decision, 'decision', 10)
        self.subscription = self.create_subscription(
            Temperature, 'smoothed', self.smoothed_callback, 10)

    def smoothed_callback(self, average: Temperature) -> None:
        """Answer an average with a decision."""
        self.cooling = self.decide(average.celsius)
        decision = Decision()
        decision.stamp = average.stamp
        decision.cooling = self.cooling
        decision.celsius = average.celsius
        self.publisher.publish(decision)

    def decide(self, celsius: float) -> bool:
        """Return whether the fan ought to run."""
        if not isfinite(celsius):
            return True
        if self.cool < celsius < self.hot:
            return self.cooling
        return celsius >= self.hot


def main(args=None) -> None:
    """Start the program."""
    run(Guard, args)


if __name__ == '__main__':
    main()
