"""What a chapter's notebook imports: `from autograder.notebook import check, drive, grade, ros`.

`ros()` switches ROS 2 on for the kernel. `drive(...)` lets a program of the workspace steer the simulated robot,
faster than real time; `side_by_side(...)` compares drives. `check(...)` runs the visible checks. `grade(...)` stands in
the locked cells. `source(...)` does for the kernel what `source install/setup.bash`
does in a terminal; `simulator(...)` runs the simulator beside it for a while. `graph()` draws the nodes that run and
their topics; `score(...)` compares one's own drives to a goal.

Students' programs run in processes of their own, never in the kernel.
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
]
# Imported when a notebook asks for them: a worker and the command line need few, and pay for each.
_MODULES = {
    "check": "checking",
    "drive": "driving",
    "graph": "node_graph",
    "score": "scoring",
    "side_by_side": "driving",
    "simulator": "simulator_session",
    "source": "sourcing",
}


def __getattr__(name: str) -> Any:
    """Import one of the functions that notebooks use."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = globals()[name] = getattr(importlib.import_module(f"{__name__}.{_MODULES[name]}"), name)
    return found


def ros() -> None:
    """Switch ROS 2 on for this kernel; after it, `import rclpy` works. Safe to run twice.

    From then on, `%%writefile` never destroys what a student wrote in the editor (see `writefile`).

    The kernel gets a ROS domain of its own, unless `ROS_DOMAIN_ID` names one: two notebooks, or two students on one
    network, do not hear each other.

    Raises:
        RosError: there is no usable ROS 2; the message says how to fix it.
    """
    if not grading():
        from IPython.core.getipython import get_ipython

        from autograder.notebook import writefile

        writefile.register(get_ipython())
        # Where it is set, setuptools warns, and colcon shows a block "stderr" for a build without a fault.
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    given = os.environ.get("ROS_DOMAIN_ID")
    activate(domain=Domain().number if given is None else int(given))
    os.environ.update(LOGS_TO_STDOUT)


def grade(assignment: str, group: str) -> NotGraded:
    """Say that the hidden checks of `group` decide after the hand-in; nothing is graded in the kernel."""
    return NotGraded(
        f"{assignment}: the hidden checks of “{group}” are run after you have handed in, outside this notebook."
    )
