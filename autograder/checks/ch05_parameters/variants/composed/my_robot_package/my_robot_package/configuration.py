"""The robot's parameters as one table."""

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

DOUBLES = {
    "max_linear_velocity": (0.3, 0.0, 1.0, "top speed [m/s]"),
    "safety_distance": (0.5, 0.2, 3.0, "it never drives nearer than this (metres)"),
    "slow_distance": (1.0, 0.2, 3.0, "it brakes from here on (metres)"),
    "control_frequency": (10.0, 1.0, 50.0, "rate of cmd_vel in hertz"),
}


class Contradiction(ValueError):
    """Two values that do not fit together."""


def contradiction(safety_distance, slow_distance):
    """Return why the distances do not fit, or an empty string."""
    problem = ""
    if not slow_distance > safety_distance:
        problem = f"slow_distance = {slow_distance} is not above safety_distance = {safety_distance}"
    return problem


def _descriptor(low, high, text):
    limits = FloatingPointRange()
    limits.from_value, limits.to_value = low, high
    return ParameterDescriptor(description=text, floating_point_range=[limits])


def declare_configuration(node):
    """Declare the whole table in one call."""
    table = [(name, default, _descriptor(low, high, text)) for name, (default, low, high, text) in DOUBLES.items()]
    table.append(
        (
            "battery_threshold",
            20,
            ParameterDescriptor(
                description="it rests below this charge, in %",
                integer_range=[IntegerRange(from_value=0, to_value=100, step=1)],
            ),
        )
    )
    table.append(
        ("robot_name", "DefaultRobot", ParameterDescriptor(description="for whom the log speaks", read_only=True))
    )
    values = {parameter.name: parameter.value for parameter in node.declare_parameters("", table)}
    if problem := contradiction(values["safety_distance"], values["slow_distance"]):
        node.get_logger().fatal(problem)
        raise Contradiction(problem)
