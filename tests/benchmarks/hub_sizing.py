"""Measure the memory and processor time that students need on a hub while they run chapter 02 at the same time.

`sudo .venv/bin/python -m tests.benchmarks.hub_sizing 30` prints a line for each student, and the peak of their total
memory; docs/jupyterhub.md has the figures. The students use the environment of this clone.
"""

from __future__ import annotations

import os
import pwd
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event
from time import monotonic

import nbformat

from autograder import course_paths
from autograder.author.course.forms import Form, in_form
from autograder.author.course.sync import Chapter
from autograder.lms.hub.trial import Hub, serving
from tests.e2e.hub_client import User

ASSIGNMENT = "02_nodes"
TICKS = os.sysconf("SC_CLK_TCK")


def usage_of(name: str) -> tuple[float, float]:
    """Return the memory of a user's processes in MiB (proportional set size), and their CPU seconds so far."""
    uid, memory, seconds = pwd.getpwnam(name).pw_uid, 0.0, 0.0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if process.stat().st_uid != uid:
                continue
            pss_line = next(
                line for line in (process / "smaps_rollup").read_text().splitlines() if line.startswith("Pss:")
            )
            times = (process / "stat").read_text().rpartition(")")[2].split()[11:15]
        except (OSError, StopIteration):
            continue  # the process has ended
        memory += int(pss_line.split()[1]) / 1024
        seconds += sum(map(int, times)) / TICKS
    return memory, seconds


def run_the_chapter(hub: Hub, name: str) -> float:
    """Log in, run each code cell of the solved chapter in a kernel, and return the seconds that the cells took."""
    user = User(hub, name).log_in()
    user.request("PUT", f"api/contents/{ASSIGNMENT}", json={"type": "directory"})
    notebook = in_form(Chapter(course_paths.chapter(ASSIGNMENT)).read(), Form.SOLVED)
    path = f"{ASSIGNMENT}/{ASSIGNMENT}.ipynb"
    user.request("PUT", f"api/contents/{path}", json={"type": "notebook", "content": nbformat.from_dict(notebook)})
    cells = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    start = monotonic()
    user.run(path, f"!cp -r {course_paths.chapter(ASSIGNMENT)}/ws .", *cells)
    return monotonic() - start


def main() -> None:
    """Run the chapter as the given number of students (two by default), and print what each of them has used."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    with tempfile.TemporaryDirectory(dir="/tmp") as scratch:
        Path(scratch).chmod(0o755)
        names = [f"student{number}" for number in range(1, count + 1)]
        with serving(Path(scratch), course_paths.ROOT, names=names) as hub, ThreadPoolExecutor(count) as pool:
            runs = {name: pool.submit(run_the_chapter, hub, name) for name in hub.students}
            peaks = dict.fromkeys(hub.students, (0.0, 0.0))
            peak, pause = 0.0, Event()
            while not all(run.done() for run in runs.values()):
                usages = {name: usage_of(name) for name in hub.students}
                peak = max(peak, sum(memory for memory, _ in usages.values()))
                for name, usage in usages.items():
                    peaks[name] = tuple(map(max, peaks[name], usage))  # type: ignore[assignment]
                pause.wait(0.5)
            for name, run in runs.items():
                print(f"{name}: {peaks[name][0]:.0f} MiB, {peaks[name][1]:.0f} core-seconds in {run.result():.0f} s")
            print(f"all {count}: {peak:.0f} MiB at the same time")


if __name__ == "__main__":
    main()
