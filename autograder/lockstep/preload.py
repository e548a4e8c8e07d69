"""What a zygote imports for programs in lockstep: what their host imports anyway."""

from __future__ import annotations

import runpy
import sys
from importlib import import_module
from pathlib import Path

HERE = Path(__file__).parent

ROS = runpy.run_path(str(HERE.parent / "ros" / "preload.py"))
READY, warm = ROS["READY"], ROS["warm"]
sys.path.insert(0, str(HERE))
for name in ("host", "pipes"):
    import_module(f"lockstep_host.{name}")
sys.path.remove(str(HERE))
