"""Python programs in sandboxes without the cost of starting Python: forked from one that has imported the most.

Most of what a small ROS program computes is its imports, and a submission is graded by dozens of programs. So the
grader keeps a *zygote*, as Android calls it: a trusted interpreter that has imported what they share, and forks for
each. Bubblewrap makes every sandbox, as for any command; in it, a shell holds the place of the program, which joins the
sandbox and gives up what bubblewrap would not have given it (`zygote_host`). No zygote reads a student's file.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from autograder.sandbox.bubblewrap import resources
from autograder.sandbox.exceptions import ZygoteError
from autograder.sandbox.spec import Sandbox

HOST = Path(__file__).with_name("zygote_host")
# In the program's place: says that the sandbox stands, and ends as the program does.
HOLDER = ["sh", "-c", 'echo >&0; read -r status || status=137; exit "$status"']
_ROOM = 2048  # bytes of command line, in which a program's own child can be called what it is
PATIENCE = 60.0  # s for a zygote's imports, or for one fork, on a machine that is busy


class Zygote:
    """One zygote, from which programs are forked one after another.

    Args:
        preload: the script that imports what the programs share. It must import nothing that they would not: a
            student's program that lacks an import would work in the grader only. What it names as `READY` they have
            as soon as they import it, and no sooner (`zygote_host/ready.py`).
        environment: its environment variables, which every program can read in its /proc.
    """

    def __init__(self, preload: Path, environment: Mapping[str, str]) -> None:
        self._lock = threading.Lock()
        self._orders, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._orders.settimeout(PATIENCE)
        with theirs:
            self._popen = subprocess.Popen(
                [sys.executable, str(HOST), str(theirs.fileno()), str(preload), " " * _ROOM],
                stdin=subprocess.DEVNULL,
                env=dict(environment),
                pass_fds=(theirs.fileno(),),
                cwd="/",
                start_new_session=True,
            )

    def spawn(self, command: list[str], spec: Sandbox, holder: int, group: str, line: int, fds: tuple[int, ...]) -> int:
        """Fork a program into a sandbox that stands; return its process id.

        Args:
            command: the program's script and its arguments.
            spec: what the sandbox was made from.
            holder: the process in the sandbox that holds the program's place.
            group: the folder of the sandbox's control group; empty where it has none.
            line: the descriptor on which the holder waits for the program's exit status.
            fds: descriptors that the program gets, under the same numbers.

        Raises:
            ZygoteError: it could not be done.
        """
        order = {
            "command": command,
            "environment": dict(spec.environment),
            "workdir": str(spec.workdir),
            "limits": resources(spec.limits),
            "holder": holder,
            "group": group,
            "fds": fds,
        }
        with self._lock:
            try:
                socket.send_fds(self._orders, [json.dumps(order).encode()], [line, *fds])
                said: dict[str, Any] = {}
                while not said.keys() >= {"program", "entered"}:
                    said |= json.loads(self._orders.recv(4096) or b'{"failed": "it has ended"}')
                    if "failed" in said:
                        raise ZygoteError(said["failed"])
            except OSError as error:
                raise ZygoteError(str(error)) from error
        return int(said["program"])

    def close(self) -> None:
        """End it; its programs go on."""
        self._orders.close()
        self._popen.kill()
        self._popen.wait()
