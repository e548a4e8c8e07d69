"""All six parameters, declared by one call."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor, ParameterType


def contradiction(safety_distance, slow_distance):
    """Return why the distances are not strictly ordered, or an empty string."""
    if slow_distance <= safety_distance:
        return f'It cannot stop at safety_distance {safety_distance} m after braking from slow_distance {slow_distance} m.'
    return ''


def declare_configuration(node):
    """Declare the parameters, and raise ValueError if the distances do not fit."""
    metres = [FloatingPointRange(from_value=0.2, to_value=3.0)]
    safety, slow, *_ = node.declare_parameters('', [
        ('safety_distance', 0.5, ParameterDescriptor(
            type=ParameterType.PARAMETER_DOUBLE, floating_point_range=metres, description='gap kept free (m)')),
        ('slow_distance', 1.0, ParameterDescriptor(
            type=ParameterType.PARAMETER_DOUBLE, floating_point_range=metres, description='gap that slows (m)')),
        ('max_linear_velocity', 0.3, ParameterDescriptor(
            floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0)], description='at most (m/s)')),
        ('control_frequency', 10.0, ParameterDescriptor(
            floating_point_range=[FloatingPointRange(from_value=1.0, to_value=50.0)], description='rate (Hz)')),
        ('battery_threshold', 20, ParameterDescriptor(
            integer_range=[IntegerRange(from_value=0, to_value=100)], description='reserve (percent)')),
        ('robot_name', 'DefaultRobot', ParameterDescriptor(read_only=True, description='call sign')),
    ])
    if reason := contradiction(safety.value, slow.value):
        raise ValueError(reason)
