"""Runs the program on the command line in lockstep."""

from __future__ import annotations

import importlib
import runpy
import sys
import traceback
from pathlib import Path

MAX_TEXT = 8000  # characters of each text of an exception that are reported


def main() -> None:
    """Install the host, run the program, and report an exception that ends it."""
    folder = Path(__file__).resolve().parent
    sys.path.insert(0, str(folder.parent))
    module = importlib.import_module(f"{folder.name}.host")
    read_fd, write_fd, start_ns = map(int, sys.argv[1:4])
    clock_rate, program = float(sys.argv[4]), sys.argv[5]
    sys.argv = sys.argv[5:]
    sys.path[:2] = [str(Path(program).parent)]  # as if Python had been started with the path of the program
    host = module.Host(module.Pipes(read_fd, write_fd), start_ns, clock_rate)
    host.install()
    try:
        runpy.run_path(program, run_name="__main__")
    except Exception as error:
        host.pipes.send(
            event="crash",
            phase=host.phase,
            type=type(error).__name__,
            message=str(error)[-MAX_TEXT:],
            traceback="".join(traceback.format_exception(error))[-MAX_TEXT:],
        )
        raise


if __name__ == "__main__":
    main()
