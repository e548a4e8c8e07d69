"""`ros2 lifecycle`: nodes, get, list and set."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState

from autograder.ros.ros2 import graph
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import Session, add_session_arguments, open_session

GET_STATE = "lifecycle_msgs/srv/GetState"
NOT_FOUND = "Node not found"


def _nodes_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all nodes even hidden ones")
    parser.add_argument("-c", "--count-nodes", action="store_true", help="Only display the number of nodes discovered")


def _nodes(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        session.settle()
        names = _lifecycle_nodes(session, include_hidden=args.all)
    for line in [len(names)] if args.count_nodes else names:
        print(line)
    return None


def _get_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument(
        "node_name", nargs="?", help="Name of the ROS node. If no name is provided, then get the state for all nodes."
    )
    _hidden_argument(parser)


def _get(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        if args.node_name:
            name = _find(session, args)
            print(_state(session, name))
            return None
        session.settle()
        for name in _lifecycle_nodes(session, include_hidden=args.include_hidden_nodes):
            print(f"{name}: {_state(session, name)}")
    return None


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    _hidden_argument(parser)
    parser.add_argument("-a", "--all", action="store_true", help="Display all existing transitions")


def _list(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        name = _find(session, args)
        for found in _transitions(session, name, "get_transition_graph" if args.all else "get_available_transitions"):
            print(
                f"- {found.transition.label} [{found.transition.id}]\n"
                f"\tStart: {found.start_state.label}\n"
                f"\tGoal: {found.goal_state.label}"
            )
    return None


def _set_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("node_name", help="Name of the ROS node")
    _hidden_argument(parser)
    parser.add_argument("transition", help="The lifecycle transition")


def _set(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        name = _find(session, args)
        available = [found.transition for found in _transitions(session, name, "get_available_transitions")]
        by_text = {str(one.id): one for one in reversed(available)} | {one.label: one for one in reversed(available)}
        if args.transition not in by_text:
            lines = "".join(f"\n- {one.label} [{one.id}]" for one in available)
            return f"Unknown transition requested, available ones are:{lines}"
        request = ChangeState.Request(transition=by_text[args.transition])
        if _answer(session, ChangeState, f"{name}/change_state", request).success:
            print("Transitioning successful")
        else:
            print("Transitioning failed", file=sys.stderr)  # and the exit code is 0, as in the real command
    return None


def _hidden_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def _lifecycle_nodes(session: Session, *, include_hidden: bool) -> list[str]:
    """Return the full names of the nodes with a life cycle that were discovered so far, sorted."""
    services = dict(graph.service_names_and_types(session, include_hidden=include_hidden))
    names = {node.full_name for node in graph.node_names(session, include_hidden=include_hidden)}
    return sorted(name for name in names if GET_STATE in services.get(f"{name}/get_state", ()))


def _find(session: Session, args: argparse.Namespace) -> str:
    """Wait for the node that the user named; return its full name, or raise Ros2Error."""
    name = graph.NodeName.parse(args.node_name).full_name
    hidden = args.include_hidden_nodes
    if not session.wait_for(lambda: name in _lifecycle_nodes(session, include_hidden=hidden)):
        raise Ros2Error(NOT_FOUND)
    return name


def _state(session: Session, name: str) -> str:
    state = _answer(session, GetState, f"{name}/get_state", GetState.Request()).current_state
    return f"{state.label} [{state.id}]"


def _transitions(session: Session, name: str, service: str) -> list[Any]:
    request = GetAvailableTransitions.Request()
    return list(_answer(session, GetAvailableTransitions, f"{name}/{service}", request).available_transitions)


def _answer(session: Session, service_type: Any, service: str, request: Any) -> Any:
    """Call a service; Ros2Error if it goes away before it answers, or never comes."""
    client = session.node.create_client(service_type, service)
    if session.wait_for(client.service_is_ready):
        future = client.call_async(request)
        session.wait_for(lambda: future.done() or not client.service_is_ready(), float("inf"))
        if future.done():
            return future.result()
    raise Ros2Error(f"The service {service} does not answer: the node has ended")


VERBS = (
    Verb("get", "Get lifecycle state for one or more nodes", _get_arguments, _get),
    Verb("list", "Output a list of available transitions", _list_arguments, _list),
    Verb("nodes", "Output a list of nodes with lifecycle", _nodes_arguments, _nodes),
    Verb("set", "Trigger lifecycle state transition", _set_arguments, _set),
)
