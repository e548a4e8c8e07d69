"""Selects the engine by its name: arrays (numpy) or compiled (numba), with the same bits from both.

What is guaranteed: the same simulation and the same commands give the same states (float64) and the same scans
(float32), bit for bit, from either engine, in any order of calls, on any processor with IEEE 754 doubles. Between a
seed and a scan stand only operations that are correctly rounded everywhere: sums, products, quotients, square roots.
What is not: that another version of this package computes the same.
"""

from __future__ import annotations

import importlib.util
from typing import Any, Literal

from sim.exceptions import EngineError

EngineName = Literal["numpy", "numba", "auto"]


def engine(name: EngineName) -> Any:
    """Return the module of an engine. Raises EngineError for a name that is unknown or not installed.

    numba is imported here and nowhere else: neither `import sim` nor the array engine needs it.
    """
    if name == "auto":
        name = "numba" if importlib.util.find_spec("numba") else "numpy"
    if name == "numpy":
        from sim.engine import arrays

        return arrays
    if name == "numba":
        try:
            from sim.engine import compiled
        except ImportError as error:
            raise EngineError(
                f"the engine 'numba' cannot be loaded ({error}); install it with "
                "`pip install 'ros2-python-course[fast]'`, or use engine='numpy'"
            ) from error
        return compiled
    raise EngineError(f"there is no engine {name!r}; use 'numpy', 'numba' or 'auto'")
