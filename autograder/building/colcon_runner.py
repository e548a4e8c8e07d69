"""Runs colcon in a sandbox.

    python colcon_runner.py ARGUMENTS-OF-COLCON

To build a Python package, colcon starts Python three times for its setup.py, and most of the time is the import of
setuptools. If this process was forked, these programs are forked, too.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path


def main() -> int | str | None:
    """Run colcon."""
    sys.path[0] = str(Path(sys.executable).parent)  # the folder of colcon's script, not of this module
    sys.argv[0] = "colcon"
    if fork_children := globals().get("fork_children"):  # set by the fork server
        fork_children()
    status: int | str | None = importlib.import_module("colcon_core.command").main()
    return status


if __name__ == "__main__":
    sys.exit(main())
