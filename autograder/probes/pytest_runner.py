"""Runs pytest in the sandbox, reports the result, and waits until the trusted side has inspected the leftovers.

    python pytest_runner.py REPORT_FD STATUS_FD GO_FD REVERSED ARGUMENTS...

After the tests, the report in JUnit XML is written to REPORT_FD and the exit status to STATUS_FD. The process then
waits until GO_FD is closed. The tests in this process can forge all of this, so the trusted side does not rely on it.

If this process was forked with the launch packages imported, the programs that the tests launch are also forked.
"""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

import pytest


class ReverseOrder:
    """A plugin that reverses the order of the test files and of the tests in each file."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Reverse the order."""
        items.reverse()


def main() -> None:
    """Run pytest with the arguments from the command line."""
    report_fd, status_fd, go_fd, backwards = (int(argument) for argument in sys.argv[1:5])
    report = Path(os.environ["HOME"]) / "report.xml"
    arguments, sys.argv = [*sys.argv[5:], f"--junitxml={report}"], ["pytest"]
    status = int(pytest.main(arguments, plugins=[ReverseOrder()] if backwards else []))
    gc.collect()  # objects without references do not count as leftovers
    sys.stdout.flush()
    with os.fdopen(report_fd, "wb") as stream:
        stream.write(report.read_bytes() if report.is_file() else b"")
    os.write(status_fd, b"%d\n" % status)
    os.read(go_fd, 1)


if __name__ == "__main__":
    sys.path.pop(0)  # so that the tests cannot import the modules beside this one
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    main()
