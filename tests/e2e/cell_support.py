"""Running a piece of test code where the grader's worker runs: in a cell, with ROS switched on.

The piece is a function of a test module. It is started by name in a new process and answers in JSON:

    answer = in_cell(probe, "argument")     # runs probe(scratch, "argument") in a cell, returns what it returned
"""

from __future__ import annotations

import importlib
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from autograder.sandbox import Process, Tier
from autograder.sandbox.cell import run_in_cell

ROOT = Path(__file__).resolve().parents[2]
_MARK = "answer: "


def in_cell(function: Callable[..., Any], *arguments: Any, tier: Tier = Tier.BUBBLEWRAP) -> Any:
    """Run `function(scratch, *arguments)` in a cell; return its answer, which crosses as JSON."""
    name = f"{Path(function.__code__.co_filename).relative_to(ROOT).with_suffix('').as_posix().replace('/', '.')}"
    report = run_in_cell(
        lambda scratch: [
            *(sys.executable, "-m", "tests.e2e.cell_support"),
            *(name, function.__name__, str(scratch), json.dumps(arguments)),
        ],
        tier,
    )
    answers = [line for line in report.output.splitlines() if line.startswith(_MARK)]
    assert report.returncode == 0, report.output
    assert answers, report.output
    return json.loads(answers[-1].removeprefix(_MARK))


def is_forked(process: Process) -> bool:
    """Return whether a sandboxed program is a fork server's; of one that has ended, nobody can say it was not."""
    try:
        parent = Path(f"/proc/{process.innermost()}/stat").read_text().rpartition(")")[2].split()[1]
        words = Path(f"/proc/{parent}/cmdline").read_bytes()
    except OSError:
        return True
    return b"autograder.prefork" in words


def main() -> None:
    """Run the function that the command line names."""
    from autograder.ros import activate

    activate()
    module, function, scratch, arguments = sys.argv[1:]
    answer = getattr(importlib.import_module(module), function)(Path(scratch), *json.loads(arguments))
    print(_MARK + json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
