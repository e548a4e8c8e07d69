"""Parameters that are declared by one function for each type."""

from functools import partial

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor


def contradiction(safety_distance, slow_distance):
    """Return why the distances do not fit, or an empty string."""
    values = {'safety_distance': safety_distance, 'slow_distance': slow_distance}
    listed = ', '.join(f'{name} {value:.2f} m' for name, value in values.items())
    return [f'the first has to be smaller: {listed}', ''][safety_distance < slow_distance]


def _declare(kind, field, node, name, default, low, high, unit):
    descriptor = ParameterDescriptor(description=f'{name.replace("_", " ")} in {unit}')
    setattr(descriptor, field, [kind(from_value=low, to_value=high)])
    return node.declare_parameter(name, default, descriptor).value


declare_double = partial(_declare, FloatingPointRange, 'floating_point_range')
declare_integer = partial(_declare, IntegerRange, 'integer_range')


def declare_configuration(node):
    """Declare the parameters one by one, and raise ValueError if the distances do not fit."""
    node.declare_parameter(
        'robot_name', 'DefaultRobot', ParameterDescriptor(read_only=True, description='name of the robot'))
    declare_double(node, 'max_linear_velocity', 0.3, 0.0, 1.0, 'm/s')
    safety = declare_double(node, 'safety_distance', 0.5, 0.2, 3.0, 'm')
    slow = declare_double(node, 'slow_distance', 1.0, 0.2, 3.0, 'm')
    declare_double(node, 'control_frequency', 10.0, 1.0, 50.0, 'Hz')
    declare_integer(node, 'battery_threshold', 20, 0, 100, 'percent')
    problem = contradiction(safety, slow)
    if problem:
        raise ValueError(problem)
