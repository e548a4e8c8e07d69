"""Selects the engine by its name: arrays (numpy) or compiled (numba). Both compute the same bits.

The same simulation and the same commands are guaranteed to give the same states (float64) and the same scans (float32),
bit for bit, with either engine, in any order of calls, on any processor with IEEE 754 doubles. Scans are computed from
a seed only with operations that are correctly rounded everywhere: sums, products, quotients and square roots. Another
version of this package may compute other results.
"""

from __future__ import annotations

import importlib.util
from typing import Any, Literal

from sim.exceptions import EngineError

EngineName = Literal["numpy", "numba", "auto"]


def engine(name: EngineName) -> Any:
    """Return the module of an engine. Raise an EngineError if the name is unknown, or the engine is not installed.

    numba is imported only here, because `import sim` and the array engine do not need it.
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
