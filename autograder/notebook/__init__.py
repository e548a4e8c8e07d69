"""The functions that a chapter's notebook imports: `from autograder.notebook import check, drive, grade, ros`.

`ros()` activates ROS 2 in the kernel. `drive(...)` lets a program from the workspace control the simulated robot,
faster than real time, and `side_by_side(...)` compares drives. `check(...)` runs the visible checks. `grade(...)` is in
the locked cells. `source(...)` is the kernel's equivalent of `source install/setup.bash`. `simulator(...)` runs the
simulator in the background. `graph()` draws the running nodes and their topics. `score(...)` ranks a student's drives.
`submit(...)` hands in the assignment on a JupyterHub that grades it immediately.

Students' programs run in separate processes, never in the kernel.
"""

from __future__ import annotations

import importlib
import os
from typing import TYPE_CHECKING, Any

from autograder.notebook.notices import NotGraded
from autograder.ros import activate
from autograder.ros.domains import Domain
from autograder.ros.environment import LOGS_TO_STDOUT
from sim.grading import grading

if TYPE_CHECKING:
    from autograder.notebook.checking import check
    from autograder.notebook.driving import drive, side_by_side
    from autograder.notebook.handing_in import submit
    from autograder.notebook.node_graph import graph
    from autograder.notebook.scoring import score
    from autograder.notebook.simulator_session import simulator
    from autograder.notebook.sourcing import source

__all__ = [
    "check",
    "drive",
    "grade",
    "graph",
    "ros",
    "score",
    "side_by_side",
    "simulator",
    "source",
    "submit",
]
# Imported on first use, because a worker and the command line need only a few of them.
_MODULES = {
    "check": "checking",
    "drive": "driving",
    "graph": "node_graph",
    "score": "scoring",
    "side_by_side": "driving",
    "simulator": "simulator_session",
    "source": "sourcing",
    "submit": "handing_in",
}


def __getattr__(name: str) -> Any:
    """Import a function that notebooks use when it is first needed."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    function = globals()[name] = getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)
    return function


def ros() -> None:
    """Activate ROS 2 in this kernel, so that `import rclpy` works. Safe to call twice.

    From then on, `%%writefile` never overwrites a student's changes from the editor (see `writefile`).

    Unless `ROS_DOMAIN_ID` is set, the kernel joins the user's ROS domain, which it shares with the user's other
    notebooks and with programs that `autograder ros` runs, but not with other users. A notebook that is being graded
    has a domain of its own.

    Raises:
        RosError: no usable ROS 2 was found, or no domain is free. The message says how to fix it.
    """
    if not grading():
        from IPython.core.getipython import get_ipython

        from autograder.notebook import writefile

        writefile.register(get_ipython())
        # If it is set, setuptools warns, and colcon shows a block "stderr" although the build succeeds.
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    domain = os.environ.get("ROS_DOMAIN_ID")
    activate(domain=int(domain) if domain else Domain(user=None if grading() else os.getuid()).number)
    os.environ.update(LOGS_TO_STDOUT)


def grade(assignment: str, group: str) -> NotGraded:
    """Return a notice that the hidden checks of `group` run after submission. Nothing is graded in the kernel."""
    return NotGraded(f"{assignment}: the hidden checks of “{group}” run after you have submitted.")
