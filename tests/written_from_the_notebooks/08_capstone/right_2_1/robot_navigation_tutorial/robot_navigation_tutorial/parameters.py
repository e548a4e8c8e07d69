"""Parameters that know their limits."""

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor


def declare(node, name, default, lowest, highest, description):
    """
    Declare a number of a node, with a description and a range.

    rclpy refuses a value of another type, and one that is not from lowest to highest, at the
    start and later. The node asks get_parameter(name).value whenever it needs the number, so
    a change has an effect immediately.
    """
    bounds = FloatingPointRange(from_value=lowest, to_value=highest)
    node.declare_parameter(
        name, default, ParameterDescriptor(
            description=description, floating_point_range=[bounds]))
