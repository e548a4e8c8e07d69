"""`ros2 topic pub`."""

from __future__ import annotations

import argparse
import itertools
import math
import time
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher

from autograder.ros.ros2 import graph
from autograder.ros.ros2.message_values import add_values_argument, make_message, read_values
from autograder.ros.ros2.parsing import ExitCode, positive_float, unsigned_int
from autograder.ros.ros2.qos import add_qos_arguments, chosen_profile
from autograder.ros.ros2.session import Session, add_session_arguments, open_session


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic pub`."""
    parser.add_argument("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')")
    parser.add_argument("message_type", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    add_values_argument(
        parser,
        "values",
        'Values to fill the message with in YAML format (e.g. "data: Hello World"), otherwise the message will '
        "be published with default values; a header may be 'auto' and a time 'now'",
    )
    parser.add_argument(
        "-r", "--rate", metavar="N", type=positive_float, default=1.0, help="Publishing rate in Hz (default: 1)"
    )
    parser.add_argument(
        "-p", "--print", metavar="N", type=int, default=1, help="Only print every N-th published message (default: 1)"
    )
    count = parser.add_mutually_exclusive_group()
    count.add_argument("-1", "--once", action="store_true", help="Publish one message and exit")
    count.add_argument("-t", "--times", type=unsigned_int, default=0, help="Publish this number of times and then exit")
    parser.add_argument(
        "-w",
        "--wait-matching-subscriptions",
        type=unsigned_int,
        help="Wait until finding the specified number of matching subscriptions "
        "(default: 1 with --once or --times, otherwise 0)",
    )
    parser.add_argument(
        "--max-wait-time-secs",
        type=positive_float,
        help="Longest time, in seconds, to wait for the matching subscriptions (default: wait forever)",
    )
    parser.add_argument(
        "--keep-alive",
        metavar="N",
        type=positive_float,
        default=0.1,
        help="Keep publishing node alive for N seconds after the last msg (default: 0.1)",
    )
    parser.add_argument("-n", "--node-name", help="Name of the created publishing node")
    add_qos_arguments(parser, "publish", "default")
    add_session_arguments(parser)


def run(args: argparse.Namespace) -> ExitCode:
    """Publish a message at a rate, until interrupted or as often as requested."""
    times = 1 if args.once else args.times
    required_subscriptions = args.wait_matching_subscriptions
    if required_subscriptions is None:
        required_subscriptions = 1 if times else 0
    if args.max_wait_time_secs is not None and required_subscriptions == 0:
        return "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
    message_class = graph.load_class(args.message_type, "msg")
    message, set_stamps = make_message(message_class, read_values(args, "values"), "field")
    with open_session(args, node_name=args.node_name) as session:
        publisher = session.node.create_publisher(message_class, args.topic_name, chosen_profile(args))
        if not _wait_for_subscriptions(session, publisher, required_subscriptions, args.max_wait_time_secs):
            return (
                f"Timed out waiting for subscribers: Expected {required_subscriptions} subcribers but only got "
                f"{publisher.get_subscription_count()} subscribers"
            )
        print("publisher: beginning loop")
        _publish(session, publisher, message, set_stamps, period=1 / args.rate, times=times, every=args.print)
        if times:
            # The last message must be sent before the publisher is destroyed.
            session.wait_for(lambda: False, timeout=args.keep_alive)
    return None


def _wait_for_subscriptions(
    session: Session, publisher: Publisher, required_subscriptions: int, limit: float | None
) -> bool:
    remaining_seconds = math.inf if limit is None else limit
    while publisher.get_subscription_count() < required_subscriptions:
        print(f"Waiting for at least {required_subscriptions} matching subscription(s)...")
        step = min(1.0, remaining_seconds)
        if session.wait_for(lambda: publisher.get_subscription_count() >= required_subscriptions, timeout=step):
            break
        remaining_seconds -= step
        if remaining_seconds <= 0:
            return False
    return True


def _publish(
    session: Session,
    publisher: Publisher,
    message: Any,
    set_stamps: list[Any],
    *,
    period: float,
    times: int,
    every: int,
) -> None:
    """Publish a message `times` times (0 means forever), at a rate that does not drift."""
    start = time.monotonic()
    for count in itertools.count(1):
        _stamp(session.node, set_stamps)
        publisher.publish(message)
        if every and count % every == 0:
            print(f"publishing #{count}: {message!r}\n")
        if count == times:
            return
        session.wait_for(lambda: False, timeout=max(0.0, start + count * period - time.monotonic()))


def _stamp(node: Node, set_stamps: list[Any]) -> None:
    now = node.get_clock().now().to_msg()
    for set_stamp in set_stamps:
        set_stamp(now)
