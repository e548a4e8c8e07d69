"""`ros2 topic echo`."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.event_handler import SubscriptionEventCallbacks

from autograder.ros.ros2 import graph
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.parsing import ExitCode, positive_float, unsigned_int
from autograder.ros.ros2.qos import add_qos_arguments, subscription_profile
from autograder.ros.ros2.session import add_session_arguments, open_session

TRUNCATE_LENGTH = 128
DISCOVERY_SECONDS = 5.0  # how long discovering the QoS of a publisher may take on a busy machine


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic echo`."""
    add_session_arguments(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to listen to (e.g. '/chatter')")
    parser.add_argument("message_type", nargs="?", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    add_qos_arguments(parser, "subscribe", "sensor_data")
    parser.add_argument("--csv", action="store_true", help="Output all recursive fields separated by commas")
    parser.add_argument(
        "--field",
        help="Echo a selected field of a message; use '.' to select sub-fields (e.g. 'pose.pose.position')",
    )
    parser.add_argument(
        "-f",
        "--full-length",
        action="store_true",
        help="Output all elements of arrays, bytes and strings; by default they end after '--truncate-length' elements",
    )
    parser.add_argument(
        "-l",
        "--truncate-length",
        type=unsigned_int,
        default=TRUNCATE_LENGTH,
        help=f"The length to truncate arrays, bytes, and strings to (default: {TRUNCATE_LENGTH})",
    )
    parser.add_argument("--no-arr", action="store_true", help="Don't print array fields of messages")
    parser.add_argument("--no-str", action="store_true", help="Don't print string fields of messages")
    parser.add_argument(
        "--flow-style", action="store_true", help="Print collections in flow style (not available with csv format)"
    )
    parser.add_argument("--no-lost-messages", action="store_true", help="Don't report when a message is lost")
    parser.add_argument("--raw", action="store_true", help="Echo the raw binary representation")
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        help="Python expression to choose the messages that are printed; 'm' is the message",
    )
    parser.add_argument("--once", action="store_true", help="Print the first message received and then exit")
    parser.add_argument("--timeout", metavar="N", type=positive_float, help="Set a timeout in seconds for waiting")
    parser.add_argument("-i", "--include-message-info", action="store_true", help="Show the associated message info")


def run(args: argparse.Namespace) -> ExitCode:
    """Print the messages of a topic until interrupted, or as limited by `--once` or `--timeout`."""
    fields = _parse_fields(args.field)
    accept = message_filter(args.filter_expr)
    with open_session(args) as session:
        node = session.node
        name = graph.full_topic_name(node, args.topic_name)
        if args.message_type is None:
            message_class = graph.message_class_of(session, args.topic_name)
            if message_class is None:
                return "Could not determine the type for the passed topic"
        else:
            message_class = graph.load_class(args.message_type, "msg")
        # The publishers' QoS is discovered after the type. A subscription with an incompatible QoS gets no messages.
        if not args.message_type:
            session.wait_for(lambda: bool(node.get_publishers_info_by_topic(name)), timeout=DISCOVERY_SECONDS)
        first_message_printed = rclpy.Future()

        def on_message(message: Any, info: Any) -> None:
            if args.once and first_message_printed.done():
                return
            part = _select_field(message, fields)
            if not accept(part):
                return
            print(_message_text(part, info, args), end="\n" if args.csv and hasattr(part, "SLOT_TYPES") else "---\n")
            if args.once:
                first_message_printed.set_result(None)

        callbacks = None if args.no_lost_messages else SubscriptionEventCallbacks(message_lost=_report_loss)
        node.create_subscription(
            message_class,
            name,
            on_message,
            subscription_profile(node, name, args),
            event_callbacks=callbacks,
            raw=args.raw,
        )
        session.spin_until(first_message_printed, args.timeout)
    return None


def _parse_fields(text: str | None) -> list[str]:
    if text is None:
        return []
    fields = [field for field in text.split(".") if field]
    if not fields:
        raise Ros2Error(f"Invalid field value '{text}'")
    return fields


def _select_field(message: Any, fields: list[str]) -> Any:
    for field in fields:
        try:
            message = getattr(message, field)
        except AttributeError as error:
            raise Ros2Error(f"Invalid field '{'.'.join(fields)}': {error}") from None
    return message


def message_filter(expression: str | None) -> Callable[[Any], bool]:
    """Compile a `--filter` expression, in which `m` is the message. Without one, the filter accepts every message.

    Raises:
        Ros2Error: the text is not a Python expression.
    """
    if expression is None:
        return lambda _: True
    try:
        code = compile(expression, "--filter", "eval")
    except SyntaxError as error:
        raise Ros2Error(f"Invalid filter expression '{expression}': {error}") from None
    # The purpose of the option is to run the user's own expression on the user's own machine.
    return lambda m: bool(eval(code, {"m": m}))


def _message_text(part: Any, info: dict[str, Any], args: argparse.Namespace) -> str:
    """Return the text to print for a message or one of its fields, with the message's info if requested."""
    import yaml
    from rosidl_runtime_py import message_to_csv, message_to_yaml

    limit = None if args.full_length else args.truncate_length
    if not hasattr(part, "SLOT_TYPES"):
        head = (
            f"---Got new message, message info:---\n{info}\n---Message data:---\n" if args.include_message_info else ""
        )
        return f"{head}{part}\n"
    if args.csv:
        row = message_to_csv(part, truncate_length=limit, no_arr=args.no_arr, no_str=args.no_str)
        return ",".join([*map(str, info.values()), row]) if args.include_message_info else row
    text = message_to_yaml(
        part, truncate_length=limit, no_arr=args.no_arr, no_str=args.no_str, flow_style=args.flow_style
    )
    return f"{yaml.dump(info)}---\n{text}" if args.include_message_info else text


def _report_loss(status: Any) -> None:
    print(
        f"A message was lost!!!\n\ttotal count change:{status.total_count_change}\n\ttotal count: {status.total_count}",
        end="---\n",
    )
