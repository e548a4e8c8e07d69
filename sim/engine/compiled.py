"""The fast engine: the scalar sources, compiled by numba without changes and without fast-math, so that no bit differs.

The machine code is stored in the user's cache folder (or in NUMBA_CACHE_DIR) under a hash of these sources. So a change
to any source recompiles all of them, and the installation may be read-only.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.extending import register_jitable

from sim.engine import exact, loops, motion, pairs, readings, shapes, traverse, trig

_SOURCES = (trig, exact, pairs, loops, traverse, shapes, motion, readings)


def _compiler() -> Callable[[Any], Any]:
    digest = hashlib.sha256()
    for module in _SOURCES:
        digest.update(Path(str(module.__file__)).read_bytes())
    base = os.environ.get("NUMBA_CACHE_DIR") or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "sim"
    folder = Path(base) / digest.hexdigest()[:16]

    def compile_function(function: Any) -> Any:
        previous_folder = numba.config.CACHE_DIR
        try:
            numba.config.CACHE_DIR = str(folder)
            return numba.njit(cache=True, error_model="numpy", nogil=True)(function)
        except (OSError, RuntimeError):  # no writable cache: compile once in each process
            return numba.njit(error_model="numpy", nogil=True)(function)
        finally:
            numba.config.CACHE_DIR = previous_folder

    return compile_function


for _module in _SOURCES:
    for _function in vars(_module).values():
        if callable(_function) and getattr(_function, "__module__", "") == _module.__name__:
            register_jitable(_function)

_compile = _compiler()
scan_ranges = _compile(loops.scan_ranges)
scan_ranges_in_grid = _compile(traverse.scan_ranges_in_grid)
beam_ranges = _compile(traverse.beam_ranges)
advance_unobstructed = _compile(motion.advance_unobstructed)
advance_near_obstacles = _compile(motion.advance_near_obstacles)
gap = _compile(shapes.gap)
to_readings = _compile(readings.to_readings)
nearest = _compile(shapes.nearest)
