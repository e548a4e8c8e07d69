"""A fork server: a worker that imports everything once and forks for each submission.

    python -m autograder.author.verification.fork_server SCRATCH DESCRIPTOR

Starting a worker takes about one core-second, as long as the checks of many submissions. The verification grades
thousands of submissions that the course itself contains, so one worker in one worker sandbox grades many of them in
sequence. A student's submission always gets a new worker in a new sandbox (`own_sandbox.run_in_own_sandbox`), and so
does an attack. The inner sandboxes around students' code are the same in both cases.

The server receives jobs. For each job, a child sends the files that it produced, and then the server sends the child's
exit status and output. Neither side unpickles anything.
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
from autograder.run.sandbox.bubblewrap import OUT
from autograder.run.sandbox.launcher import warm_up
from autograder.run.sandbox.messages import send_message

MAX_OUTPUT = 1024 * 1024  # bytes; if a child's output is longer, the reply contains only its end


def serve(scratch: Path, client: Connection) -> None:
    """Run each job in a new child, and remove the files that it leaves, until the client closes the connection."""
    log_file = scratch / "output.log"
    while True:
        job = Job.from_json(client.recv_bytes().decode())
        # Computed here, so that the children inherit the cached values.
        assert job.suite.version + job.suite.files_digest
        child = os.fork()
        if child == 0:
            line.set_line(client)
            _work(job, log_file)
        _, status = os.waitpid(child, 0)
        _reap_orphans()
        output = log_file.read_bytes()[-MAX_OUTPUT:].decode("utf-8", errors="replace") if log_file.is_file() else ""
        reply = {"do": "done", "status": os.waitstatus_to_exitcode(status), "output": output}
        for path in (*scratch.iterdir(), *(scratch / OUT).glob("*")):
            if not path.is_mount():
                subprocess.run(["rm", "-rf", "--", path], check=True)
        send_message(client, reply)


def _work(job: Job, log_file: Path) -> None:
    """Grade one submission in the child process and exit with status 0, or with 1 after an exception."""
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


def _reap_orphans() -> None:
    """Reap the exited processes that a child left. This server is process 1 in its sandbox, so it is their parent."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG) != (0, 0):
            pass


def main() -> None:
    """Serve with the folder and the descriptor that the command line names."""
    worker.prepare()
    for profile in PROFILES:  # a server that a child starts would end with that child
        warm_up(profile)
    PROFILES["tests"].load()  # a worker also needs most of these modules
    gc.collect()
    gc.freeze()  # keeps the children's garbage collectors away from shared memory pages
    with Connection(int(sys.argv[2])) as client, suppress(EOFError):
        serve(Path(sys.argv[1]), client)


if __name__ == "__main__":
    main()
