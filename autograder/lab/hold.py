"""Runs a command and outlives it, so that the trusted side sees what the command has left behind.

    python hold.py DESCRIPTOR COMMAND...

Runs in the sandbox, by itself. When the command has ended, it writes the exit status to DESCRIPTOR and waits to be
killed. The command is its first child; whatever loses its parent becomes another one.
"""

import ctypes
import os
import signal
import subprocess
import sys

PR_SET_CHILD_SUBREAPER = 36


def main() -> None:
    """Run the command that the command line holds."""
    descriptor, command = int(sys.argv[1]), sys.argv[2:]
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    child = subprocess.Popen(command)
    os.write(descriptor, f"{child.wait()}\n".encode())
    while True:
        signal.pause()


if __name__ == "__main__":
    main()
