"""Fills caches for worker sandboxes, which see the grader's code read-only and start with an empty home."""

from __future__ import annotations

import compileall
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

from autograder import course_paths

_ANSWERS = re.compile(r"/(variants|versions)/")  # answers among a chapter's checks, which the grader does not import


@cache
def compile_grader() -> None:
    """Compile the grader's modules once per process. If their folder is read-only, each worker compiles them itself."""
    for folder in (course_paths.ROOT / "autograder", course_paths.ROOT / "sim", course_paths.CHECKS):
        if os.access(folder, os.W_OK):
            compileall.compile_dir(folder, quiet=2, rx=_ANSWERS)


@cache
def fonts() -> Path | None:
    """Return matplotlib's list of this machine's fonts, which takes a second to create, or None if that fails."""
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path(os.environ.get("HOME", "/nonexistent"), ".cache")).absolute()
    pattern = "matplotlib/fontlist-*.json"
    if not any(folder.glob(pattern)):
        # `python -c` imports from its working folder, which may be a submission.
        command = [sys.executable, "-c", "import matplotlib.font_manager"]
        variables = {**os.environ, "XDG_CACHE_HOME": str(folder)}
        subprocess.run(command, cwd="/", env=variables, capture_output=True, check=False)
    return max(folder.glob(pattern), default=None)
