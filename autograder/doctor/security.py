"""`autograder doctor --security`: runs programs that try to escape from a sandbox, and reports which succeed."""

from __future__ import annotations

import json
import os
import socket
import sys
import time
from contextlib import suppress
from pathlib import Path

from autograder.doctor.escapes import CANARY, ESCAPES, Escape
from autograder.doctor.finding import Finding, Status
from autograder.ros import activate
from autograder.run.sandbox import Isolation, Mount, Sandbox, cgroup
from autograder.run.sandbox.isolation import namespaces_failure
from autograder.run.sandbox.launcher import launch, warm_up
from autograder.run.sandbox.worker_sandbox import run_in_worker_sandbox

VERDICTS = ("Every escape was blocked.", "An escape succeeded: docs/security.md explains the limits.")
_PROFILE = "lockstep"  # the import profile of the fork server that also forks students' nodes


def attempt(escape: Escape, home: Path, port: int, profile: str | None) -> str:
    """Try an escape in a sandbox inside this worker sandbox. Describe what it reached, or return an empty string.

    Args:
        escape: the escape to try.
        home: an empty folder that the program can write to.
        port: an open port of the machine outside the worker sandbox.
        profile: the import profile of the fork server that forks the program; None to start a new interpreter.
    """
    program = home / "program.py"
    program.write_text(f"PORT, OUTSIDE = {port}, {os.getpid()}\n{escape.program}")
    spec = Sandbox(home, mounts=(Mount(home, writable=True),), network=escape.network, limits=escape.limits)
    earlier_processes = processes()
    with launch([sys.executable, str(program)], spec, profile=profile) as process:
        process.wait(escape.limits.wall_seconds + 60)
    problems = [line for line in process.output.splitlines() if line.startswith("OUT")]
    if process.exit_reason not in escape.exit_reasons:
        problems.append(f"it ended as {process.exit_reason and process.exit_reason.value}: {process.output[-200:]}")
    deadline = time.monotonic() + 20
    while (survivors := processes() - earlier_processes) and time.monotonic() < deadline:
        time.sleep(0.05)
    return "; ".join([*problems, *(f"process {pid} survived" for pid in survivors)])


def processes() -> set[int]:
    """Return the processes in this worker sandbox's network namespace, except zombies."""
    own_namespace, pids = Path("/proc/self/ns/net").readlink(), set()
    for pid in map(int, filter(str.isdigit, os.listdir("/proc"))):
        with suppress(OSError):
            state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
            if Path(f"/proc/{pid}/ns/net").readlink() == own_namespace and state not in "ZX":
                pids.add(pid)
    return pids


def examine() -> tuple[Finding, ...]:
    """Try every escape on this machine, in a new interpreter and in a forked one, and return the findings."""
    failure = namespaces_failure()
    if failure is not None:
        state = f"not tried: {failure}; without namespaces, a student's code has the rights of the grader's user"
        return (Finding("isolation", Status.MISSING, state, "autograder doctor"),)
    reached_by_escape: dict[str, str] = {}
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = str(server.getsockname()[1])
        command = [sys.executable, "-m", "autograder.doctor.security", port]
        report = run_in_worker_sandbox(lambda scratch: [*command, str(scratch)], Isolation.BUBBLEWRAP)
    for line in report.output.splitlines():
        with suppress(ValueError):
            reached_by_escape |= json.loads(line)
    return tuple(
        _finding(escape, reached_by_escape.get(escape.id, f"not tried: {report.output[-300:]}")) for escape in ESCAPES
    )


def _finding(escape: Escape, problems: str) -> Finding:
    if problems:
        return Finding(escape.id, Status.MISSING, f"not blocked, a program can {escape.description}: {problems}")
    return Finding(escape.id, Status.OK, f"blocked: a program cannot {escape.description}")


def main() -> None:
    """Try every escape in this process's worker sandbox, and print a JSON object about each."""
    activate()
    os.environ["CANARY"] = CANARY
    port, scratch = int(sys.argv[1]), Path(sys.argv[2])
    warm_up(_PROFILE)
    limits_processes = "pids" in cgroup.bounds()
    for number, escape in enumerate(ESCAPES):
        problems = []
        for profile in (None, _PROFILE):
            home = scratch / f"{number}-{profile}"
            home.mkdir()
            if escape.id == "fork bomb" and not limits_processes:
                problems.append("not tried: nothing limits root's processes here")
            else:
                problems.append(attempt(escape, home, port, profile))
        print(json.dumps({escape.id: "; ".join(dict.fromkeys(filter(None, problems)))}), flush=True)


if __name__ == "__main__":
    main()
