"""Runs colcon in a sandbox.

    python colcon_runner.py ARGUMENTS-OF-COLCON

To build one Python package, colcon starts Python three times for its setup.py, mostly to import setuptools. If this
process was forked, they are forked, too.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path


def main() -> int | str | None:
    """Run colcon."""
    sys.path[0] = str(Path(sys.executable).parent)  # where colcon's own script is, and no module of this folder
    sys.argv[0] = "colcon"
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    status: int | str | None = importlib.import_module("colcon_core.command").main()
    return status


if __name__ == "__main__":
    sys.exit(main())
