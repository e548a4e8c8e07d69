"""Runs colcon in a sandbox.

    python colcon_runner.py ARGUMENTS-OF-COLCON

To build a Python package, colcon runs its setup.py in three processes, which spend most of their time on the import of
setuptools. If this process was forked, these processes are forked as well.

Two threads of colcon write output: one prints what the packages' builds do, the other logs. Here, each `print` writes
only once, so that no log line comes between a line and its line end.
"""

from __future__ import annotations

import builtins
import importlib
import sys
from pathlib import Path
from typing import TextIO


def main() -> int | str | None:
    """Run colcon."""
    sys.path[0] = str(Path(sys.executable).parent)  # the folder of colcon's script, not of this module
    sys.argv[0] = "colcon"
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    builtins.print = print_in_one_write  # type: ignore[assignment]
    status: int | str | None = importlib.import_module("colcon_core.command").main()
    return status


def print_in_one_write(
    *values: object, sep: str | None = None, end: str | None = None, file: TextIO | None = None, flush: bool = False
) -> None:
    """Do the same as `print`, but write the values and the line end together."""
    stream = sys.stdout if file is None else file
    stream.write((" " if sep is None else sep).join(map(str, values)) + ("\n" if end is None else end))
    if flush:
        stream.flush()


if __name__ == "__main__":
    sys.exit(main())
