"""Runs pytest in the sandbox, reports how it ended, and stays until the trusted side has looked at what is left.

    python pytest_host.py ANSWER_FD GO_FD REVERSED REPORT ARGUMENTS...

When pytest has ended, its exit status and its report, a file of JUnit XML, go to ANSWER_FD; the process then waits for
the end of GO_FD. All of it is in the power of the tests that run here: the trusted side takes what it hears for their
claim.

Many such runs are made for one submission, most of them short. A third of one's time went into looking for garbage
among pytest's own modules, while they were loaded and when the interpreter took everything down again: neither is done.
Nor is the generator of messages imported, which a message's module does if it can. Where this process has the launch
packages from its zygote, what the tests launch is forked, too.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import os
import sys
from pathlib import Path
from typing import Any

gc.disable()

import pytest  # noqa: E402

gc.freeze()
gc.enable()
sys.modules.setdefault("rosidl_generator_py.generate_py_impl", None)  # type: ignore[arg-type]

ZYGOTE_HOST = Path(__file__).parents[1] / "sandbox" / "zygote_host"


class Reversed:
    """Lets the tests run in the opposite order, first files then tests."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Turn the order round."""
        items.reverse()


def leave() -> None:
    """End the process at the end of its exit functions: threads have been waited for, only its modules are left."""
    os._exit(0)


def open_nursery() -> Any:
    """Let what tests launch be forked; in the processes of that, return what is to be run."""
    sys.path.insert(0, str(ZYGOTE_HOST))
    nursery = importlib.import_module("nursery")
    del sys.path[0]
    for name in [name for name in sys.modules if name.partition(".")[0] == "autograder"]:
        del sys.modules[name]  # none of it is there for a student's tests
    return nursery.open_here(forget=("launch", "launch_ros", "standin_notice"))


def main() -> None:
    """Run pytest with the arguments of the command line."""
    atexit.register(leave)  # first of all, so that it is called last
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
    if program := open_nursery() if "launch" in sys.modules else None:
        exec(*program)
    else:
        main()
