"""`ros2 service`: list, info and call."""

from __future__ import annotations

import argparse
import time

from autograder.ros.ros2 import graph
from autograder.ros.ros2.message_values import add_values_argument, make_message, read_values
from autograder.ros.ros2.parsing import ExitCode, Verb, positive_float
from autograder.ros.ros2.session import LOOKUP_QUIET, add_session_arguments, open_session


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the service type")
    parser.add_argument(
        "-c", "--count-services", action="store_true", help="Only display the number of services discovered"
    )
    _hidden_argument(parser)


def _list(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        session.settle()
        services = graph.service_names_and_types(session, include_hidden=args.include_hidden_services)
    if args.count_services:
        print(len(services))
        return None
    for name, types in services:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None


def _info_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("service_name", help="Name of the ROS service to get info (e.g. '/talker/list_parameters')")


def _info(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        types = graph.types_of_service(session, args.service_name)
        if not types:
            return f"Unknown service '{args.service_name}'"
        session.settle(max_quiet=LOOKUP_QUIET)
        print(f"Type: {types[0] if len(types) == 1 else types}")
        print(f"Clients count: {session.node.count_clients(args.service_name)}")
        print(f"Services count: {session.node.count_services(args.service_name)}")
    return None


def _call_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')")
    parser.add_argument("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')")
    add_values_argument(
        parser,
        "values",
        "Values to fill the service request with in YAML format (e.g. '{data: true}'), "
        "otherwise the request will be sent with default values",
    )
    parser.add_argument(
        "-r", "--rate", metavar="N", type=positive_float, help="Repeat the call at a specific rate in Hz"
    )


def _call(args: argparse.Namespace) -> ExitCode:
    service_class = graph.load_class(args.service_type, "srv")
    request, _ = make_message(service_class.Request, read_values(args, "values"), "field", allow_stamps=False)
    with open_session(args) as session:
        client = session.node.create_client(service_class, args.service_name)
        if not client.service_is_ready():
            print("waiting for service to become available...")
            session.wait_for(client.service_is_ready, timeout=float("inf"))
        while True:
            start = time.monotonic()
            print(f"requester: making request: {request!r}\n")
            future = client.call_async(request)
            session.spin_until(future)
            # `result` raises the exception of a failed call.
            print(f"response:\n{future.result()!r}\n")
            if args.rate is None:
                return None
            session.wait_for(lambda: False, timeout=max(0.0, start + 1 / args.rate - time.monotonic()))


def _hidden_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--include-hidden-services", action="store_true", help="Consider hidden services as well")


VERBS = (
    Verb("call", "Call a service", _call_arguments, _call),
    Verb("info", "Print information about a service", _info_arguments, _info),
    Verb("list", "Output a list of available services", _list_arguments, _list),
)
