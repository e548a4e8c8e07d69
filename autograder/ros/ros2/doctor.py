"""`ros2 doctor` (`ros2 wtf`): checks this machine and the ROS graph."""

from __future__ import annotations

import argparse
import os
import platform
import socket
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import metadata

from autograder.ros import find
from autograder.ros.ros2 import graph
from autograder.ros.ros2.exceptions import NotCoveredError
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import Session, add_session_arguments, open_session

Row = tuple[str, object]


@dataclass(frozen=True)
class Check:
    """A check of the machine or the graph.

    Attributes:
        name: its name in the summary of failed checks.
        title: the heading of its report.
        errors: a function that yields a sentence for each error.
        warnings: a function that yields a sentence for each possible problem.
        report: a function that yields the names and values that `--report` prints.
    """

    name: str
    title: str
    errors: Callable[[Session], Iterator[str]]
    warnings: Callable[[Session], Iterator[str]]
    report: Callable[[Session], Iterator[Row]]


def _no_messages(_: Session) -> Iterator[str]:
    yield from ()


def _platform_errors(_: Session) -> Iterator[str]:
    if platform.system() != "Linux":
        yield f"the ROS 2 wheels of this project are for Linux, this is {platform.system()}"


def _platform_report(_: Session) -> Iterator[Row]:
    yield "system", platform.system()
    yield "platform info", platform.platform()
    yield "release", platform.release()
    yield "processor", platform.machine()
    yield "python", platform.python_version()


def _network_errors(_: Session) -> Iterator[str]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.bind(("127.0.0.1", 0))
        except OSError as error:
            yield f"the loopback interface cannot be used ({error}): `ip link set lo up`"


def _network_warnings(_: Session) -> Iterator[str]:
    if all(name == "lo" for _, name in socket.if_nameindex()):
        yield "only the loopback interface is there: other machines cannot be reached"


def _network_report(_: Session) -> Iterator[Row]:
    for index, name in socket.if_nameindex():
        yield f"interface {index}", name
    yield "ROS_DOMAIN_ID", os.environ.get("ROS_DOMAIN_ID", "0 (default)")


def _installation_report(_: Session) -> Iterator[Row]:
    yield "distribution name", os.environ.get("ROS_DISTRO", "unknown")
    yield "installation", find().describe()
    yield "prefixes", os.environ.get("AMENT_PREFIX_PATH", "")


def _rmw_report(_: Session) -> Iterator[Row]:
    from rclpy.utilities import get_rmw_implementation_identifier

    yield "middleware name", get_rmw_implementation_identifier()


def _package_report(_: Session) -> Iterator[Row]:
    versions = {
        d.metadata["Name"]: d.version for d in metadata.distributions() if d.metadata["Name"].startswith("ros-")
    }
    yield from sorted(versions.items())


def _topic_warnings(session: Session) -> Iterator[str]:
    for name, _ in graph.topic_names_and_types(session):
        # Every node publishes these two, and only tools subscribe to them.
        if name in ("/parameter_events", "/rosout"):
            continue
        publishers, subscribers = session.node.count_publishers(name), session.node.count_subscribers(name)
        if publishers > subscribers == 0:
            yield f"Publisher without subscriber detected on {name}."
        elif subscribers > publishers == 0:
            yield f"Subscriber without publisher detected on {name}."


def _topic_report(session: Session) -> Iterator[Row]:
    for name, _ in graph.topic_names_and_types(session):
        yield "topic", name
        yield "publisher count", session.node.count_publishers(name)
        yield "subscriber count", session.node.count_subscribers(name)


CHECKS = (
    Check("platform", "PLATFORM INFORMATION", _platform_errors, _no_messages, _platform_report),
    Check("network", "NETWORK CONFIGURATION", _network_errors, _network_warnings, _network_report),
    Check("installation", "ROS 2 INFORMATION", _no_messages, _no_messages, _installation_report),
    Check("middleware", "RMW MIDDLEWARE", _no_messages, _no_messages, _rmw_report),
    Check("package", "PACKAGE VERSIONS", _no_messages, _no_messages, _package_report),
    Check("topic", "TOPIC LIST", _no_messages, _topic_warnings, _topic_report),
)


def _arguments(parser: argparse.ArgumentParser) -> None:
    report_options = parser.add_mutually_exclusive_group()
    report_options.add_argument("-r", "--report", action="store_true", help="Print all reports")
    report_options.add_argument(
        "-rf", "--report-failed", action="store_true", help="Print reports of failed checks only"
    )
    parser.add_argument(
        "-ep", "--exclude-packages", action="store_true", help="Exclude package checks or report from doctor"
    )
    parser.add_argument(
        "-iw",
        "--include-warnings",
        action="store_true",
        help="Include warnings as failed checks. Warnings are ignored by default.",
    )
    add_session_arguments(parser)
    parser.add_argument("verb", nargs="?", metavar="hello", help="Not covered by this stand-in")


def _run(args: argparse.Namespace) -> ExitCode:
    if args.verb is not None:
        raise NotCoveredError(f"`ros2 doctor {args.verb}`")
    checks = [check for check in CHECKS if not (args.exclude_packages and check.name == "package")]
    with open_session(args) as session:
        session.settle()
        if args.report:
            for check in checks:
                _print_report(check, session)
            return None
        failed = [check for check in checks if not _passes(check, session, args.include_warnings)]
        if args.report_failed:
            for check in failed:
                _print_report(check, session)
    if not failed:
        print(f"\nAll {len(checks)} checks passed\n")
        return None
    print(f"\n{len(failed)}/{len(checks)} check(s) failed\n")
    print("Failed modules:", *(check.name for check in failed))
    return 1


def _passes(check: Check, session: Session, warnings_fail: bool) -> bool:
    errors, warnings = list(check.errors(session)), list(check.warnings(session))
    for text in (*(f"ERROR: {text}" for text in errors), *warnings):
        print(f"ros2 doctor: {check.name}: UserWarning: {text}", file=sys.stderr)
    return not errors and not (warnings_fail and warnings)


def _print_report(check: Check, session: Session) -> None:
    rows = list(check.report(session))
    width = max((len(name) for name, _ in rows), default=0)
    print(f"\n   {check.title}")
    for name, value in rows:
        print(f"{name:<{width}} : {value}")


VERB = Verb("doctor", "Check ROS setup and other potential issues", _arguments, _run)
