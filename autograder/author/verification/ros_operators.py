"""Mutation operators for typical errors in ROS programs: quality of service, time, parameters, exceptions, units."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from autograder.author.verification.python_operators import Mutation, NodeInContext, NodeMutation, Source

QOS_POSITION = {"create_publisher": 2, "create_subscription": 3}
QOS = "__import__('rclpy.qos').qos."
SENSOR_DATA = "qos_profile_sensor_data"
LATCHED = f"{QOS}QoSProfile(depth=10, durability={QOS}DurabilityPolicy.TRANSIENT_LOCAL)"
SYSTEM_CLOCK = "__import__('rclpy.clock').clock.Clock()"
STEADY_CLOCK = "__import__('rclpy.clock').clock.Clock(clock_type=__import__('rclpy.clock').clock.ClockType.STEADY_TIME)"
NOW = "self.get_clock().now().to_msg()"
ZERO = "__import__('builtin_interfaces.msg').msg.Time()"
FROM_HEADER = "__import__('rclpy.time').time.Time.from_msg({}.header.stamp)"
_PAIRS = "min max any all ceil floor sin cos isinf isnan linear angular left right x y range_min range_max"
_PAIRS += (
    " angle_min angle_max TRANSIENT_LOCAL VOLATILE RELIABLE BEST_EFFORT KEEP_LAST KEEP_ALL ACCEPT REJECT succeed abort"
)
SWAPPED = dict(zip(_PAIRS.split()[::2], _PAIRS.split()[1::2], strict=True))
SWAPPED |= {right: left for left, right in SWAPPED.items()}


def ros_mutations(source: Source, context: NodeInContext) -> Iterator[NodeMutation]:
    """Yield the ROS-specific mutations of a node."""
    node = context.node
    if isinstance(node, ast.Attribute | ast.Name):
        yield from _names(source, node, context)
    elif isinstance(node, ast.Call):
        yield from _calls(source, node, context)
    elif isinstance(node, ast.Assign) and len(node.targets) == 1:
        arguments = [argument.arg for argument in context.function.args.args[1:]] if context.function else []
        if source.text(node.value) == "self.get_clock().now()" and len(arguments) == 1:
            yield "stamp", node.value, FROM_HEADER.format(arguments[0])


def _names(source: Source, node: ast.Attribute | ast.Name, context: NodeInContext) -> Iterator[NodeMutation]:
    name = node.attr if isinstance(node, ast.Attribute) else node.id
    text = source.text(node)
    is_called = isinstance(context.ancestors[0], ast.Call) and context.ancestors[0].func is node
    if name in SWAPPED and (isinstance(node, ast.Attribute) or is_called):
        yield "swapped", node, text[: -len(name)] + SWAPPED[name]
    if not isinstance(node, ast.Attribute) or not isinstance(node.ctx, ast.Load):
        return
    if text.endswith(".header.stamp"):
        yield "stamp", node, NOW
    elif name == "header" and isinstance(context.ancestors[0], ast.keyword | ast.Assign):
        yield "stamp", node, f"type({text})(stamp={NOW}, frame_id={text}.frame_id)"
    if name == "value" and isinstance(node.value, ast.Call) and getattr(node.value.func, "attr", "") == "get_parameter":
        assert isinstance(node.value.func, ast.Attribute)
        owner, key = source.text(node.value.func.value), source.text(node.value.args[0])
        yield "read once", node, f"{owner}.__dict__.setdefault(('once', {key}), {text})"


def _calls(source: Source, node: ast.Call, context: NodeInContext) -> Iterator[NodeMutation]:
    name, text = getattr(node.func, "attr", getattr(node.func, "id", "")), source.text(node)
    if name in ("radians", "degrees") and len(node.args) == 1:
        yield "units", node, f"({source.text(node.args[0])})"
    if name in QOS_POSITION and len(node.args) > QOS_POSITION[name]:
        qos = node.args[QOS_POSITION[name]]
        new = ["10"] if source.text(qos) == SENSOR_DATA else []
        if isinstance(qos, ast.Constant):
            new = ["1", f"{QOS}{SENSOR_DATA}", LATCHED]
        yield from (("qos", qos, replacement) for replacement in new)
    if name == "create_timer":
        yield "wall time", node, f"{text[:-1].rstrip().rstrip(',')}, clock={STEADY_CLOCK})"
    if text == NOW:
        yield "stamp", node, ZERO


def is_queue_length(context: NodeInContext) -> bool:
    """Return whether a node is a queue length. The operator "qos" makes the relevant mutations of queue lengths."""
    outer = context.ancestors[0]
    if isinstance(outer, ast.keyword):
        return outer.arg == "depth"
    position = QOS_POSITION.get(getattr(getattr(outer, "func", None), "attr", ""), -1)
    return isinstance(outer, ast.Call) and len(outer.args) > position >= 0 and outer.args[position] is context.node


def multi_node_mutations(source: Source, context: NodeInContext) -> Iterator[Mutation]:
    """Yield the mutations that replace more than one node: a handler's body, a decorator."""
    node = context.node
    if isinstance(node, ast.ExceptHandler):
        start, end = source.span(node.body[0], node.body[-1])
        for name, body in (("let through", "raise"), ("swallowed", "pass")):
            if source.data[start:end].decode() != body:
                yield name, ((start, end, body),)
    if isinstance(node, ast.Try) and node.finalbody:
        yield "no finally", ((*source.span(node.finalbody[0], node.finalbody[-1]), "pass"),)
    for decorator in getattr(node, "decorator_list", ()):
        start, end = source.span(decorator)
        yield "no decorator", ((source.data.rindex(b"@", 0, start), end, ""),)


def wall_time(source: Source, nodes: list[ast.AST]) -> Iterator[Mutation]:
    """Yield a mutation that replaces the ROS clock with the machine's clock wherever these nodes use it."""
    clocks = [node for node in nodes if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "get_clock"]
    if clocks:
        yield "wall time", tuple((*source.span(node), SYSTEM_CLOCK) for node in clocks)
