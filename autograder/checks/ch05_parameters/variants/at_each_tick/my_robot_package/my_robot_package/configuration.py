"""Parameters as dataclasses, declared in a loop."""

from dataclasses import dataclass

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


@dataclass(frozen=True)
class Number:
    """A numeric parameter with limits."""

    name: str
    default: float
    low: float
    high: float
    text: str

    def descriptor(self):
        """Return its descriptor, with a range of the default's type."""
        kind, field = (
            (IntegerRange, 'integer_range') if isinstance(self.default, int)
            else (FloatingPointRange, 'floating_point_range'))
        return ParameterDescriptor(
            name=self.name, description=self.text, **{field: [kind(from_value=self.low, to_value=self.high)]})


NUMBERS = (
    Number('battery_threshold', 20, 0, 100, 'In percent of the battery. Below it, no motion.'),
    Number('control_frequency', 10.0, 1.0, 50.0, 'How often it decides, in Hz.'),
    Number('max_linear_velocity', 0.3, 0.0, 1.0, 'The limit of linear.x in m/s.'),
    Number('safety_distance', 0.5, 0.2, 3.0, 'Stop here: distance in m.'),
    Number('slow_distance', 1.0, 0.2, 3.0, 'Brake from here: distance in m.'),
)


def contradiction(safety_distance, slow_distance):
    """Return why the distances do not fit, or an empty string."""
    fits = safety_distance < slow_distance
    return '' if fits else 'safety_distance=%.3f m >= slow_distance=%.3f m' % (safety_distance, slow_distance)


def declare_configuration(node):
    """Declare the name and the numbers, and raise ValueError if the distances do not fit."""
    node.declare_parameter('robot_name', 'DefaultRobot', ParameterDescriptor(description='its name', read_only=True))
    for number in NUMBERS:
        node.declare_parameter(number.name, number.default, number.descriptor())
    distances = node.get_parameters(['safety_distance', 'slow_distance'])
    if reason := contradiction(*(distance.value for distance in distances)):
        raise ValueError(reason)
