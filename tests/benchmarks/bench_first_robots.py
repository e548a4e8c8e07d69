"""Measure how long a newcomer waits for the first graded robots: set-up and `make demo` in a new clone.

The clone contains the last commit. pip's cache is warm, and all other caches are empty. This takes several minutes and
needs the sources of the packages, so it runs only on request: `make bench BENCH_ARGS=first_robots`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from autograder.course_paths import ROOT


def figures() -> dict[str, float]:
    """Return `first_robots_s`, in seconds. A first set-up, which is not measured, fills pip's cache."""
    _seconds("setup")
    return {"first_robots_s": round(_seconds("demo"), 1)}


def _seconds(target: str) -> float:
    """Return the seconds that a target of make takes in a new clone."""
    pip = subprocess.run([sys.executable, "-m", "pip", "cache", "dir"], check=True, capture_output=True, text=True)
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)  # root's workers run as other users
        caches = {"XDG_CACHE_HOME": str(Path(name, "cache")), "PIP_CACHE_DIR": pip.stdout.strip()}
        inherited = {key: value for key, value in os.environ.items() if not key.startswith(("MAKE", "MFLAGS"))}
        clone = Path(name, "clone")
        subprocess.run(["git", "clone", "--quiet", ROOT, clone], check=True)
        start = time.monotonic()
        subprocess.run(["make", target], cwd=clone, env={**inherited, **caches}, check=True)
        return time.monotonic() - start
