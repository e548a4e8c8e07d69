"""Runs colcon in a sandbox.

    python colcon_runner.py ARGUMENTS-OF-COLCON

To build a Python package, colcon starts Python three times for its setup.py, and most of the time is the import of
setuptools. If this process was forked, these programs are forked, too.

Two threads of colcon write: one prints what the packages' builds do, the other logs. Each print is one write here, so
no log line comes between a line and its end.
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
    """Do what `print` does; `print` writes each value, and the end of the line, by a call of its own."""
    stream = sys.stdout if file is None else file
    stream.write((" " if sep is None else sep).join(map(str, values)) + ("\n" if end is None else end))
    if flush:
        stream.flush()


if __name__ == "__main__":
    sys.exit(main())
