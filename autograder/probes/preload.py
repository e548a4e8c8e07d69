"""What a zygote imports for a student's tests and functions: pytest, and what `import numpy` and `import rclpy` bring.

No part of rclpy that a program has to import by itself is among it.
"""

from __future__ import annotations

import gc
import runpy
import sys
from importlib import import_module
from pathlib import Path

gc.disable()  # nothing here is garbage, and to look for it took a third of the time
ROS = runpy.run_path(str(Path(__file__).parents[1] / "ros" / "preload.py"))
READY, warm = ROS["READY"], ROS["warm"]
for name in ("numpy", "rclpy", "pytest"):
    import_module(name)
for plugin in sys.modules["_pytest.config"].default_plugins:
    import_module(f"_pytest.{plugin}")
gc.enable()
