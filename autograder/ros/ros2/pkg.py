"""`ros2 pkg`: list, prefix and executables. `pkg_create` implements create."""

from __future__ import annotations

import argparse
from pathlib import Path

from autograder.ros.ros2 import packages, pkg_create
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.parsing import ExitCode, Verb


def _no_arguments(parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def _list(args: argparse.Namespace) -> ExitCode:
    for name in packages.package_names():
        print(name)
    return None


def _prefix_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("--share", action="store_true", help="Show share directory for the package")


def _prefix(args: argparse.Namespace) -> ExitCode:
    prefix = _prefix_or_error(args.package_name)
    print(prefix / "share" / args.package_name if args.share else prefix)
    return None


def _executables_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", nargs="?", help="The package name")
    parser.add_argument("--full-path", action="store_true", help="Show the full path of the executables")


def _executables(args: argparse.Namespace) -> ExitCode:
    names = [args.package_name] if args.package_name else packages.package_names()
    for name in names:
        for path in packages.executables_of(name):
            print(path if args.full_path else f"{name} {path.name}")
    return None


def _prefix_or_error(package: str) -> Path:
    try:
        return packages.prefix_of(package)
    except Ros2Error:
        # Unlike `ros2 run`, the verbs of `ros2 pkg` do not name the package.
        raise Ros2Error("Package not found") from None


VERBS = (
    Verb("create", "Create a new ROS 2 package", pkg_create.add_arguments, pkg_create.run),
    Verb("executables", "Output a list of package specific executables", _executables_arguments, _executables),
    Verb("list", "Output a list of available packages", _no_arguments, _list),
    Verb("prefix", "Output the prefix path of a package", _prefix_arguments, _prefix),
)
