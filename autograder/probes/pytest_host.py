"""Runs pytest in the sandbox, reports how it ended, and stays until the trusted side has looked at what is left.

    python pytest_host.py ANSWER_FD GO_FD REVERSED REPORT ARGUMENTS...

When pytest has ended, its exit status and its report, a file of JUnit XML, go to ANSWER_FD; the process then waits for
the end of GO_FD. All of it is in the power of the tests that run here: the trusted side takes what it hears for their
claim.

Where this process was forked with the launch packages, what the tests launch is forked, too. The generator of messages
is not imported, which a message's module does if it can.
"""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path

import pytest

sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]


class Reversed:
    """Lets the tests run in the opposite order, first files then tests."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Turn the order round."""
        items.reverse()


def main() -> None:
    """Run pytest with the arguments of the command line."""
    answer, go, backwards = (int(argument) for argument in sys.argv[1:4])
    report = Path(sys.argv[4])
    arguments, sys.argv = [*sys.argv[5:], f"--junitxml={report}"], ["pytest"]
    status = int(pytest.main(arguments, plugins=[Reversed()] if backwards else []))
    gc.collect()  # what nothing refers to any more is not left behind
    sys.stdout.flush()
    text = report.read_bytes() if report.is_file() else b""
    with os.fdopen(answer, "wb") as stream:
        stream.write(b"%d %d\n%b" % (status, len(text), text))
    os.read(go, 1)


if __name__ == "__main__":
    sys.path.pop(0)  # this file's folder is none of the tests' business
    if fork_children := globals().get("fork_children"):  # given by `prefork`
        fork_children()
    main()
