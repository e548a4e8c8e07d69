"""Runs students' code where it can do no harm.

A *worker sandbox* (`worker_sandbox.py`) contains the trusted worker of one submission, in its own user and network
namespaces and with a scratch file system of limited size. In it, all student code runs in a *sandbox* of its own
(`bubblewrap.py`): a process tree that sees a read-only system and the workspace. `process.py` enforces its `Limits`. A
fork server (`autograder.run.fork_server`) starts most programs, from an interpreter that has already imported their
modules.

Both exist at two isolation levels (`isolation.py`): `bubblewrap`, and the weaker `process` for machines without
namespaces.
"""

from autograder.run.sandbox.isolation import Isolation, best_isolation, require
from autograder.run.sandbox.limits import Limits
from autograder.run.sandbox.process import ExitReason, Process
from autograder.run.sandbox.spec import Mount, Sandbox

__all__ = ["ExitReason", "Isolation", "Limits", "Mount", "Process", "Sandbox", "best_isolation", "require"]
