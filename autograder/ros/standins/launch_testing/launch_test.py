"""The command `launch_test FILE`."""

from __future__ import annotations

import argparse
import importlib.util
import sys
from pathlib import Path
from typing import NoReturn

from standin_notice import guard

from .loader import load_tests
from .print_arguments import print_arguments_of_launch_description
from .test_result import junit
from .test_runner import run_all


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="launch_test",
        description="Launch integration testing tool.",
        epilog="This is the course's stand-in for launch_testing. The real one: make real-launch.",
    )
    parser.add_argument("launch_test_file", help="Path to the launch test.")
    parser.add_argument("--package-name", help="Name of the package the test is in, for the report.")
    parser.add_argument("-v", "--verbose", action="store_true", help="Run with verbose output")
    parser.add_argument(
        "-s",
        "--show-args",
        "--show-arguments",
        action="store_true",
        help="Show arguments that may be given to the launch test.",
    )
    parser.add_argument(
        "launch_arguments",
        nargs="*",
        help="Arguments in '<name>:=<value>' format (for duplicates, last one wins).",
    )
    parser.add_argument("--junit-xml", dest="xmlpath", help="Do write xUnit reports to specified path.")
    return parser


def run(args: argparse.Namespace) -> int:
    """Run a test file; return 0 if all tests passed, else 1.

    Raises:
        Exception: the file is no launch test.
    """
    file = Path(args.launch_test_file).absolute()
    package = args.package_name or file.stem
    spec = importlib.util.spec_from_file_location(package, file)
    if spec is None or spec.loader is None:
        raise Exception(f"Test file '{file}' is not a Python file")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    runs = load_tests(module, f"{package}.{file.stem}.launch_tests")
    for one in runs:
        one.validate()
    if args.show_args:
        description, _ = runs[0].described(lambda: None)
        print_arguments_of_launch_description(launch_description=description)
        return 0
    results = run_all(runs, args.launch_arguments, debug=args.verbose)
    if args.xmlpath:
        junit(results, f"{package}.{file.stem}").write(args.xmlpath, encoding="utf-8", xml_declaration=True)
    failed = any(not result.wasSuccessful() for result in results.values())
    return int(failed)


def main() -> NoReturn:
    """Run the file that the command line names, and exit: 0 all tests passed, 1 one failed, 2 misuse."""
    parser = _parser()
    args = parser.parse_args()
    if not Path(args.launch_test_file).is_file():
        parser.error(f"Test file '{args.launch_test_file}' does not exist")
    try:
        code = run(args)
    except Exception as error:
        parser.error(str(error))
    sys.exit(code)


__getattr__ = guard(__name__)


if __name__ == "__main__":
    main()
