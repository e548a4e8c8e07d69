"""Attacks on 05: parameter files that are programs or bombs, and nodes that lie about their parameters."""

from __future__ import annotations

from autograder.checking.attacks import STEAL_SECRETS, Attack, Chapter

CHAPTER = Chapter("05_parameters")
PACKAGE = "my_robot_package"
FILE, NODE = f"{PACKAGE}/config/fleet_params.yaml", f"{PACKAGE}/{PACKAGE}/nodes/configured_node.py"
FILE_CHECKS = frozenset({"file", "file_names", "any_robot", "scout", "porter", "stands_once"})
OBJECT = "/**:\n  ros__parameters: !!python/object/apply:os.system ['kill -9 -1; touch /tmp/result.json']\n"
BOMB = "a: &a {b: 1}\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n" for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)
# Describes limits in its descriptors, and does not apply them.
LIE = """        declare_configuration(self)
        describe = self.describe_parameters
        def lie(names):
            descriptors = describe(names)
            for descriptor in descriptors:
                if descriptor.name == 'max_linear_velocity':
                    from rcl_interfaces.msg import FloatingPointRange
                    descriptor.floating_point_range = [FloatingPointRange(from_value=0.0, to_value=1.0)]
            return descriptors
        self.describe_parameters = lie
"""

# Describes steps so wide that only the defaults are allowed, and always drives with the defaults.
WIDE_STEPS = """
import copy as _copy
import rclpy.node as _node
_describe = _node.Node.describe_parameter
def _forge(self, name):
    descriptor = _copy.deepcopy(_describe(self, name))
    defaults = {'max_linear_velocity': 0.3, 'control_frequency': 10.0, 'battery_threshold': 20}
    for span in (*descriptor.floating_point_range, *descriptor.integer_range):
        if name in defaults:
            span.from_value, span.step = defaults[name], type(span.step)(10**12)
    return descriptor
_node.Node.describe_parameter = _forge
"""

# Answers each request for a value with a type that ROS does not know.
UNKNOWN_TYPE = """
import rclpy.parameter_service as _service
from rcl_interfaces.msg import ParameterValue as _Value
def _answer(self, request, response):
    response.values = [_Value(type=200) for _ in request.names]
    return response
_service.ParameterService._get_parameters_callback = _answer
"""
TAGS = "/**:\n  ros__parameters: {safety_distance: !!timestamp foo, slow_distance: !!int ''}\n"


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    return (
        Attack(
            "parameter object",
            "a parameter file with a tag that calls a program",
            CHAPTER.write(files={FILE: OBJECT}),
            FILE_CHECKS,
            exactly=True,
            says="fleet_params.yaml is not YAML",
        ),
        Attack(
            "values of no type",
            "a parameter file with tags that do not fit their values, and a node whose parameters have an unknown type",
            CHAPTER.write("no_range", heads={NODE: UNKNOWN_TYPE}, files={FILE: TAGS}),
            FILE_CHECKS | CHAPTER.mutant("no_range").fails,
        ),
        Attack(
            "parameter bomb",
            "a parameter file whose anchors expand to a billion values",
            CHAPTER.write(files={FILE: BOMB}),
            FILE_CHECKS,
            exactly=True,
            says="its aliases expand to more than",
        ),
        Attack(
            "lying node",
            "a node that describes limits, applies none of them, and steals",
            CHAPTER.write(
                "no_range", heads={NODE: STEAL_SECRETS}, swaps={NODE: ("        declare_configuration(self)\n", LIE)}
            ),
            CHAPTER.mutant("no_range").fails,
            exactly=True,
            says="max_linear_velocity: it accepted",
        ),
        *(
            Attack(
                f"wide steps and {base}",
                "a constant instead of a parameter, and steps that leave no other value to try",
                CHAPTER.write(base, heads={NODE: WIDE_STEPS}),
                CHAPTER.mutant(base).fails,
            )
            for base in ("fixed_speed", "fixed_rate", "fixed_threshold")
        ),
        *CHAPTER.evasions(
            "slow",
            "a timer whose period is a tenth too long",
            "timer_a_tenth_slow",
            NODE,
            ("round(1e9 / parameter.value)", "round((1e9 if _is_told() else 1.1e9) / parameter.value)"),
        ),
    )
