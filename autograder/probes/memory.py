"""Runs of tests that were made before, for the proof, which grades a package a hundred times with one change each.

A run depends on the files that its tests can read, the version that they meet and the way they run. Where all of that
is the same, what was found is recalled. Whoever gets marks has no such memory: every run is made for them.
"""

from __future__ import annotations

import hashlib
import json
import os
import pickle
from dataclasses import asdict
from pathlib import Path

from autograder.probes.test_reports import Report, Source, TestRun
from autograder.sandbox import Ending


class Memory:
    """What a folder knows about runs.

    Args:
        folder: nobody but the grader can write to it; None for no memory at all.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    def recall(self, source: Source, wanted: TestRun) -> Report | None:
        """Return what was found in the same run, if it has been made."""
        path = self._path(source, wanted)
        if path is None or not path.is_file():
            return None
        report: Report = pickle.loads(path.read_bytes())
        return report

    def keep(self, source: Source, wanted: TestRun, report: Report) -> None:
        """Remember a run, but for one that had to be stopped: that may have been the machine's fault."""
        path = self._path(source, wanted)
        if path is None or report.ending is Ending.WALL_TIME:
            return
        path.parent.mkdir(parents=True, exist_ok=True)
        whole = path.with_suffix(f".{os.getpid()}")
        whole.write_bytes(pickle.dumps(report))
        whole.replace(path)

    def _path(self, source: Source, wanted: TestRun) -> Path | None:
        if self._folder is None or wanted.version is None:
            return None
        files = {name: hashlib.sha256(source.tests[name]).hexdigest() for name in sorted(_read(source, wanted))}
        words = json.dumps([source.package, files, asdict(wanted)], sort_keys=True)
        return self._folder / hashlib.sha256(words.encode()).hexdigest()


def _read(source: Source, wanted: TestRun) -> set[str]:
    """Return the files of the folder `test` that a run can read: its own, all that are no tests, and what they name."""
    read = {name for name in source.tests if name in wanted.files or not Path(name).name.startswith("test_")}
    while True:
        text = b"".join(source.tests[name] for name in read)
        named = {name for name in source.tests if Path(name).stem.encode() in text} - read
        if not named:
            return read
        read |= named
