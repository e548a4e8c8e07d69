"""Run the program that the command line names, in lockstep."""

from __future__ import annotations

import importlib
import runpy
import sys
import traceback
from pathlib import Path

TEXT = 8000  # characters of an exception's texts that are reported


def main() -> None:
    """Run the program."""
    here = Path(__file__).resolve().parent
    sys.path.insert(0, str(here.parent))
    module = importlib.import_module(f"{here.name}.host")
    read_fd, write_fd, start_ns = map(int, sys.argv[1:4])
    clock_rate, program = float(sys.argv[4]), sys.argv[5]
    sys.argv = sys.argv[5:]
    sys.path[:2] = [str(Path(program).parent)]  # as Python sets it for a program that is started by its path
    host = module.Host(module.Pipes(read_fd, write_fd), start_ns, clock_rate)
    host.install()
    try:
        runpy.run_path(program, run_name="__main__")
    except Exception as error:
        host.pipes.send(
            event="crash",
            phase=host.phase,
            type=type(error).__name__,
            message=str(error)[-TEXT:],
            traceback="".join(traceback.format_exception(error))[-TEXT:],
        )
        raise


if __name__ == "__main__":
    main()
