"""Runs pytest in the sandbox, reports the result, and stays until the trusted side has inspected the leftovers.

    python pytest_runner.py REPORT_FD STATUS_FD GO_FD REVERSED ARGUMENTS...

When pytest has ended, its report of JUnit XML goes to REPORT_FD and its exit status to STATUS_FD; the process then
waits for the end of GO_FD. The tests in this process can forge all of this, and the trusted side does not rely on it.

If this process was forked with the launch packages, programs that the tests launch are forked, too.
"""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

import pytest


class Reversed:
    """Lets the tests run in the opposite order, first files then tests."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Turn the order round."""
        items.reverse()


def main() -> None:
    """Run pytest with the arguments of the command line."""
    answer, told, go, backwards = (int(argument) for argument in sys.argv[1:5])
    report = Path(os.environ["HOME"]) / "report.xml"
    arguments, sys.argv = [*sys.argv[5:], f"--junitxml={report}"], ["pytest"]
    status = int(pytest.main(arguments, plugins=[Reversed()] if backwards else []))
    gc.collect()  # objects without references do not count as leftovers
    sys.stdout.flush()
    with os.fdopen(answer, "wb") as stream:
        stream.write(report.read_bytes() if report.is_file() else b"")
    os.write(told, b"%d\n" % status)
    os.read(go, 1)


if __name__ == "__main__":
    sys.path.pop(0)  # this file's folder is none of the tests' business
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    main()
