"""What a zygote imports for colcon: all that colcon imports for `colcon build` of Python packages, and setuptools."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress
from importlib import import_module
from importlib.metadata import distributions
from pathlib import Path

# colcon looks for CMake when it is imported, and finds it in the sandbox there.
os.environ["PATH"] = os.pathsep.join([str(Path(sys.prefix) / "bin"), "/usr/bin", "/bin"])
gc.disable()  # nothing here is garbage
for name in ("asyncio.subprocess", "setuptools", "distutils.core", "colcon_core.command"):
    import_module(name)
for point in (point for package in distributions() for point in package.entry_points):
    if point.group.startswith("colcon_") or point.group in ("distutils.commands", "egg_info.writers"):
        with suppress(Exception):  # colcon and setuptools do without it, too
            point.load()
gc.enable()
