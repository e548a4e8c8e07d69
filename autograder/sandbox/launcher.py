"""Starting a sandboxed command in the tier that this process works in."""

from __future__ import annotations

import os
import signal

from autograder.sandbox import bubblewrap, cgroup
from autograder.sandbox.process import Process
from autograder.sandbox.spec import Sandbox
from autograder.sandbox.tiers import Tier

TIER_VARIABLE = "AUTOGRADER_TIER"


def current_tier() -> Tier:
    """Return the tier of the cell that this process is in; `process` outside any cell."""
    return Tier(os.environ.get(TIER_VARIABLE, Tier.PROCESS.value))


def heed_interrupts() -> None:
    """Let what this process will start hear Ctrl-C; call it in the main thread.

    A shell's background job ignores SIGINT, and all its descendants inherit that: the same node would end on Ctrl-C
    when it is graded in the foreground, and not when it is graded in the background.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def launch(command: list[str], spec: Sandbox, *, pass_fds: tuple[int, ...] = ()) -> Process:
    """Start `command` in the sandbox that `spec` describes, as strongly as the current tier can."""
    group = cgroup.make(spec.limits.tasks)
    contained = current_tier() is Tier.BUBBLEWRAP
    command = bubblewrap.sandbox(command, spec) if contained else [*bubblewrap.rlimits(spec.limits), *command]
    return Process(
        group.enter(command) if group else command,
        spec.limits,
        environment={"PATH": os.defpath, **({} if contained else spec.environment)},
        pass_fds=pass_fds,
        cwd=None if contained else spec.workdir,
        contained=contained,
        at_end=group.close if group else None,
    )
