"""A fork server: a worker that has imported everything once, and forks for each submission.

    python -m autograder.proof.fork_server SCRATCH DESCRIPTOR

Starting a worker costs about a core-second, as much as many a submission's checks. The proof grades hundreds of
submissions of its own, so it lets each lane's share one cell, one after another. Whoever grades students' submissions
gives each a cell of its own (`pipeline.in_own_cell`); the sandboxes around students' code are the same in both.

It receives jobs. A reply is the child's exit status and what it wrote. All are JSON; nothing is unpickled.
"""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from autograder.checks import suites
from autograder.checks.suites import Suite
from autograder.grading import worker
from autograder.grading.job import Job
from autograder.prefork.profiles import PROFILES
from autograder.sandbox.launcher import warm_up

OUTPUT = 1024 * 1024  # bytes of a child's words that are replied, the last ones


def serve(scratch: Path, client: Connection) -> None:
    """Do jobs until the client ends, each in a child of its own that leaves no file."""
    said = scratch / "said.log"
    while True:
        job = Job.from_json(client.recv_bytes().decode())
        suite = suites.hidden(job.assignment)
        assert suite.version  # read once for all, too
        child = os.fork()
        if child == 0:
            _work(job, suite, said)
        _, status = os.waitpid(child, 0)
        output = said.read_bytes()[-OUTPUT:].decode("utf-8", errors="replace") if said.is_file() else ""
        reply = {"status": os.waitstatus_to_exitcode(status), "output": output}
        for left in scratch.iterdir():
            subprocess.run(["rm", "-rf", "--", left], check=True)
        client.send_bytes(json.dumps(reply).encode())


def _work(job: Job, suite: Suite, said: Path) -> None:
    """Be the child: grade one submission, and end as a worker that was started for it alone does."""
    status = 1
    try:
        log = os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(log, 1)
        os.dup2(log, 2)
        worker.work(job, suite)
        status = 0
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def main() -> None:
    """Serve in the folder and on the descriptor that the command line names."""
    worker.prepare()
    for profile in PROFILES:  # a server that a child warmed up would end with it
        warm_up(profile)
    PROFILES["tests"].load()  # a worker needs most of that, too
    gc.collect()
    gc.freeze()  # what the children share is not theirs to look through
    with Connection(int(sys.argv[2])) as client, suppress(EOFError):
        serve(Path(sys.argv[1]), client)


if __name__ == "__main__":
    main()
