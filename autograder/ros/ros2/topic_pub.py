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
from autograder.ros.ros2.filling import add_values, filled, given_values
from autograder.ros.ros2.parsing import ExitCode, positive_float, unsigned_int
from autograder.ros.ros2.qos import add_qos_arguments, chosen_profile
from autograder.ros.ros2.session import Session, add_session_arguments, open_session


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of `ros2 topic pub`."""
    parser.add_argument("topic_name", help="Name of the ROS topic to publish to (e.g. '/chatter')")
    parser.add_argument("message_type", help="Type of the ROS message (e.g. 'std_msgs/msg/String')")
    add_values(
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
    often = parser.add_mutually_exclusive_group()
    often.add_argument("-1", "--once", action="store_true", help="Publish one message and exit")
    often.add_argument("-t", "--times", type=unsigned_int, default=0, help="Publish this number of times and then exit")
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
    """Publish a message at a rate, until interrupted or as often as asked."""
    times = 1 if args.once else args.times
    wanted = args.wait_matching_subscriptions
    if wanted is None:
        wanted = 1 if times else 0
    if args.max_wait_time_secs is not None and wanted == 0:
        return "--max-wait-time-secs option is only effective with --wait-matching-subscriptions, --once or --times"
    message_class = graph.load_class(args.message_type, "msg")
    message, stamps = filled(message_class, given_values(args, "values"), "field")
    with open_session(args, node_name=args.node_name) as session:
        publisher = session.node.create_publisher(message_class, args.topic_name, chosen_profile(args))
        if not _wait_for_subscriptions(session, publisher, wanted, args.max_wait_time_secs):
            return (
                f"Timed out waiting for subscribers: Expected {wanted} subcribers but only got "
                f"{publisher.get_subscription_count()} subscribers"
            )
        print("publisher: beginning loop")
        _publish(session, publisher, message, stamps, period=1 / args.rate, times=times, every=args.print)
        if times:
            # The last message must leave before the publisher goes.
            session.wait_for(lambda: False, timeout=args.keep_alive)
    return None


def _wait_for_subscriptions(session: Session, publisher: Publisher, wanted: int, limit: float | None) -> bool:
    left = math.inf if limit is None else limit
    while publisher.get_subscription_count() < wanted:
        print(f"Waiting for at least {wanted} matching subscription(s)...")
        step = min(1.0, left)
        if session.wait_for(lambda: publisher.get_subscription_count() >= wanted, timeout=step):
            break
        left -= step
        if left <= 0:
            return False
    return True


def _publish(
    session: Session, publisher: Publisher, message: Any, stamps: list[Any], *, period: float, times: int, every: int
) -> None:
    """Publish on a steady beat, without drift; `times` 0 means for ever."""
    start = time.monotonic()
    for count in itertools.count(1):
        _stamp(session.node, stamps)
        publisher.publish(message)
        if every and count % every == 0:
            print(f"publishing #{count}: {message!r}\n")
        if count == times:
            return
        session.wait_for(lambda: False, timeout=max(0.0, start + count * period - time.monotonic()))


def _stamp(node: Node, stamps: list[Any]) -> None:
    now = node.get_clock().now().to_msg()
    for stamp in stamps:
        stamp(now)
