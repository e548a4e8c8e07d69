"""The reference of the capstone driven again and again: are the traces the same to the last bit?

    python -m tests.benchmarks.repeat_capstone -n 200

Each time, its packages are built in a new cell, the three programs are stepped together through the drives of the
hidden suite, and all that the robot did and the programs said is digested. Every second time, busy processes take the
machine's cores. Exit status: 0 when all digests are equal.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

ASSIGNMENT = "08_capstone"
SEED = 2026
TOPICS = ("/clearance", "/cmd_vel", "/health")


def traces(scratch: Path) -> dict[str, str]:
    """Build and drive the reference; return a digest of each drive's recording and of each topic's messages."""
    from autograder import suites
    from autograder.grading.observed import bring
    from autograder.lab import Workspace
    from autograder.ros import activate
    from autograder.suites.ch08_capstone.drives import Drives
    from autograder.suites.mutants import lay_down_reference
    from autograder.visible.ch08_capstone.messages import load_messages, types
    from autograder.visible.ch08_capstone.system import System

    packages = suites.load(ASSIGNMENT).packages
    (scratch / "home").mkdir()
    workspace = Workspace(scratch / "ws", activate(), scratch / "home")
    lay_down_reference(packages, workspace.root)
    bring(workspace, packages)
    found = {}
    with System(workspace, types(load_messages(workspace))) as system:
        drives = Drives(lambda: system, SEED)
        for name in ("room", "corridor", "faulty"):
            run = getattr(drives, name).recording
            arrays = (run.times_ns, run.poses, run.velocities, run.commands, run.odometry, run.clearances)
            found[name] = _digest(b"".join(array.tobytes() for array in arrays))
        for topic in TOPICS:
            said = [(stamped.seconds, repr(stamped.message)) for stamped in system.lab.messages(topic)]
            found[topic] = _digest(repr(said).encode())
    return found


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


@contextmanager
def busy(cores: int) -> Iterator[None]:
    """Keep cores busy meanwhile."""
    command = [sys.executable, "-I", "-S", "-c", "while True: pass"]
    processes = [subprocess.Popen(command) for _ in range(cores)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


def main() -> int:
    """Drive it as often as the command line says; say what differs."""
    from tests.e2e.cell_support import in_cell

    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.repeat_capstone", description="See above.")
    parser.add_argument("-n", type=int, default=10, metavar="N", help="how often (default: 10)")
    times = parser.parse_args().n
    first: dict[str, str] = {}
    different = 0
    for number in range(1, times + 1):
        load = (os.cpu_count() or 1) if number % 2 == 0 else 0
        began = time.monotonic()
        with busy(load):
            found = in_cell(traces)
        first = first or found
        names = [name for name, digest in found.items() if digest != first[name]]
        different += bool(names)
        said = f"differs in {', '.join(names)}" if names else "the same"
        print(f"{number:4} of {times}, {load} busy: {time.monotonic() - began:5.1f} s, {said}", flush=True)
    print(f"{times - different} of {times} alike: {first}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
