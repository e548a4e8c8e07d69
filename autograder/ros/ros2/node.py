"""`ros2 node`: list and info."""

from __future__ import annotations

import argparse
import sys

from rclpy.action import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)

from autograder.ros.ros2 import graph
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import LOOKUP_QUIET, Session, add_session_arguments, open_session


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="Only display the number of nodes discovered")


def _list(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        session.settle()
        names = graph.node_names(session, include_hidden=args.all)
    if args.count_nodes:
        print(len(names))
        return None
    graph.warn_of_duplicates(names)
    for name in sorted(node.full_name for node in names):
        print(name)
    return None


def _info_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("node_name", help="Node name to request information")
    parser.add_argument(
        "--include-hidden", action="store_true", help="Display hidden topics, services, and actions as well"
    )


def _info(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        node = graph.find_node(session, args.node_name)
        if node is None or node.full_name != args.node_name:  # as in the real command, only full names are accepted
            return f"Unable to find node '{args.node_name}'"
        session.settle(max_quiet=LOOKUP_QUIET)
        count = graph.node_names(session, include_hidden=True).count(node)
        if count > 1:
            print(
                f'There are {count} nodes in the graph with the exact name "{node.full_name}". '
                "You are seeing information about only one of them.",
                file=sys.stderr,
            )
        print(node.full_name)
        for heading, names_and_types in _sections(session, node, args.include_hidden):
            print(f"  {heading}:")
            # An empty section consists of one blank line, as in the real command.
            print(*(f"    {name}: {', '.join(types)}" for name, types in names_and_types), sep="\n")
    return None


def _sections(
    session: Session, described_node: graph.NodeName, include_hidden: bool
) -> list[tuple[str, graph.NamesAndTypes]]:
    node = session.node
    name, namespace = described_node.name, described_node.namespace
    sections: list[tuple[str, graph.NamesAndTypes]] = [
        ("Subscribers", node.get_subscriber_names_and_types_by_node(name, namespace)),
        ("Publishers", node.get_publisher_names_and_types_by_node(name, namespace)),
        ("Service Servers", node.get_service_names_and_types_by_node(name, namespace)),
        ("Service Clients", node.get_client_names_and_types_by_node(name, namespace)),
        ("Action Servers", get_action_server_names_and_types_by_node(node, name, namespace)),
        ("Action Clients", get_action_client_names_and_types_by_node(node, name, namespace)),
    ]
    return [
        (heading, sorted(pair for pair in pairs if include_hidden or not graph.has_hidden_part(pair[0])))
        for heading, pairs in sections
    ]


VERBS = (
    Verb("info", "Output information about a node", _info_arguments, _info),
    Verb("list", "Output a list of available nodes", _list_arguments, _list),
)
