"""Running students' code where it can do no harm.

A submission is handled in a *cell* (`cell.py`): a trusted worker in a user and network namespace that no other
submission is in, with a scratch file system of limited size. In it every piece of student code runs in a *sandbox*
(`bubblewrap.py`): its own process tree that sees a read-only system and the workspace, watched (`process.py`) against
`Limits`. Most programs are forked into it, from an interpreter that has done their imports
(`autograder.run.fork_server`).

Both exist at two isolation levels (`isolation.py`): `bubblewrap`, and the weaker `process` for machines without
namespaces.
"""

from autograder.run.sandbox.isolation import Isolation, best_isolation, require
from autograder.run.sandbox.limits import Limits
from autograder.run.sandbox.process import ExitReason, Process
from autograder.run.sandbox.spec import Mount, Sandbox

__all__ = ["ExitReason", "Isolation", "Limits", "Mount", "Process", "Sandbox", "best_isolation", "require"]
