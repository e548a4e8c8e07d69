"""A fork server: a worker that has imported everything once, and forks for each submission.

    python -m autograder.author.verification.fork_server SCRATCH DESCRIPTOR

Starting a worker costs about a core-second, as much as the checks of many a submission. The proof grades thousands of
submissions, which the course itself wrote. So one worker in one cell grades many of them, one after another. The
submission of a student always gets a new worker in a new cell (`own_cell.in_own_cell`), and so does an attack. The
sandboxes around students' code are the same in both.

It receives jobs. A child sends what it leaves, and the server then the child's exit status with what it wrote. Nothing
is unpickled.
"""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from autograder.grade import worker
from autograder.grade.job import Job
from autograder.run.fork_server.profiles import PROFILES
from autograder.run.sandbox import line
from autograder.run.sandbox.launcher import warm_up
from autograder.run.sandbox.parcel import send_message

OUTPUT = 1024 * 1024  # bytes: the end of a child's output that goes into the reply


def serve(scratch: Path, client: Connection) -> None:
    """Do jobs until the client ends, each in a child of its own that leaves no file."""
    log_file = scratch / "output.log"
    while True:
        job = Job.from_json(client.recv_bytes().decode())
        assert job.suite.version + job.suite.files_digest  # read once for all, too
        child = os.fork()
        if child == 0:
            line.take(client)
            _work(job, log_file)
        _, status = os.waitpid(child, 0)
        output = log_file.read_bytes()[-OUTPUT:].decode("utf-8", errors="replace") if log_file.is_file() else ""
        reply = {"do": "done", "status": os.waitstatus_to_exitcode(status), "output": output}
        for left in scratch.iterdir():
            subprocess.run(["rm", "-rf", "--", left], check=True)
        send_message(client, reply)


def _work(job: Job, log_file: Path) -> None:
    """Grade one submission in the child process, and exit: with status 0, or with 1 after an exception."""
    status = 1
    try:
        log = os.open(log_file, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(log, 1)
        os.dup2(log, 2)
        worker.work(job)
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
