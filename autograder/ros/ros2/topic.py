"""`ros2 topic`: list and info. Other modules implement echo, pub and hz."""

from __future__ import annotations

import argparse

from autograder.ros.ros2 import graph, topic_echo, topic_pub, topic_rate
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import LOOKUP_QUIET, Session, add_session_arguments, open_session


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the topic type")
    parser.add_argument(
        "-c", "--count-topics", action="store_true", help="Only display the number of topics discovered"
    )
    parser.add_argument("--include-hidden-topics", action="store_true", help="Consider hidden topics as well")
    parser.add_argument(
        "-v",
        "--verbose",
        action="store_true",
        help="List full details about each topic",
    )


def _list(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        session.settle()
        topics = graph.topic_names_and_types(session, include_hidden=args.include_hidden_topics)
        if args.count_topics:
            print(len(topics))
        elif args.verbose:
            _print_endpoints(session, topics)
        else:
            for name, types in topics:
                print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None


def _print_endpoints(session: Session, topics: graph.NamesAndTypes) -> None:
    for heading, noun, count in (
        ("Published", "publisher", session.node.count_publishers),
        ("Subscribed", "subscriber", session.node.count_subscribers),
    ):
        print(f"{heading} topics:")
        for name, types in topics:
            number = count(name)
            if number:
                print(f" * {name} [{', '.join(types)}] {number} {noun}{'s' if number > 1 else ''}")
        print()


def _info_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to get info (e.g. '/chatter')")
    parser.add_argument(
        "-v",
        "--verbose",
        action="store_true",
        help="Print node names, types and QoS of each publisher and subscription",
    )


def _info(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        types = graph.types_of_topic(session, args.topic_name)
        if not types:
            return f"Unknown topic '{args.topic_name}'"
        session.settle(max_quiet=LOOKUP_QUIET)
        end = "\n\n" if args.verbose else "\n"
        print(f"Type: {types[0] if len(types) == 1 else types}", end=end)
        node = session.node
        for heading, count, details in (
            ("Publisher", node.count_publishers, node.get_publishers_info_by_topic),
            ("Subscription", node.count_subscribers, node.get_subscriptions_info_by_topic),
        ):
            print(f"{heading} count: {count(args.topic_name)}", end=end)
            if args.verbose:
                for info in details(args.topic_name):
                    print(info, end=end)
    return None


VERBS = (
    Verb("echo", "Output messages from a topic", topic_echo.add_arguments, topic_echo.run),
    Verb("hz", "Print the average receiving rate to screen", topic_rate.hz_arguments, topic_rate.hz),
    Verb("info", "Print information about a topic", _info_arguments, _info),
    Verb("list", "Output a list of available topics", _list_arguments, _list),
    Verb("pub", "Publish a message to a topic", topic_pub.add_arguments, topic_pub.run),
)
