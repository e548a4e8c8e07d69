"""`ros2 pkg`: list, prefix, executables and xml; create has a module of its own."""

from __future__ import annotations

import argparse
import xml.etree.ElementTree as ET
from pathlib import Path

from autograder.ros.ros2 import packages, pkg_create
from autograder.ros.ros2.exceptions import Ros2Error
from autograder.ros.ros2.parsing import ExitCode, Verb


def _no_arguments(parser: argparse.ArgumentParser) -> None:
    """Take none."""


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


def _xml_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("-t", "--tag", help="The XML tag to output, e.g. 'version'")


def _xml(args: argparse.Namespace) -> ExitCode:
    path = _prefix_or_error(args.package_name) / "share" / args.package_name / "package.xml"
    if not path.is_file():
        return f"Could not find the package.xml of '{args.package_name}', expected at {path}"
    text = path.read_text(encoding="utf-8")
    try:
        manifest = ET.fromstring(text)
        tags = [] if args.tag is None else manifest.findall(f".//{args.tag}")
    except (ET.ParseError, SyntaxError) as error:
        return f"{path} or the tag '{args.tag}' cannot be read: {error}"
    if args.tag is None:
        print(ET.tostring(manifest, encoding="unicode"))
        return None
    if not tags:
        return "XML tag not found"
    for tag in tags:
        print((tag.text or "").strip())
    return None


def _prefix_or_error(package: str) -> Path:
    try:
        return packages.prefix_of(package)
    except Ros2Error:
        # The text of these verbs; `ros2 run` names the package.
        raise Ros2Error("Package not found") from None


VERBS = (
    Verb("create", "Create a new ROS 2 package", pkg_create.add_arguments, pkg_create.run),
    Verb("executables", "Output a list of package specific executables", _executables_arguments, _executables),
    Verb("list", "Output a list of available packages", _no_arguments, _list),
    Verb("prefix", "Output the prefix path of a package", _prefix_arguments, _prefix),
    Verb("xml", "Output the XML of the package manifest or a specific tag", _xml_arguments, _xml),
)
