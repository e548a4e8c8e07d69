"""The zygote's process: it waits for orders, and forks for each.

    python zygote_host SOCKET_FD PRELOAD ROOM

It is trusted, lives outside every sandbox, and runs no line of a student's: PRELOAD is a script of the grader's. For
each order a child, the attendant, joins the sandbox that bubblewrap has made, forks the program's process into it, and
gives its exit status to the process there that bubblewrap waits for. The program's process gives up whatever is left of
the outside (see `confinement`) before it reads anything of a student's, and then becomes the program. Nobody reads
ROOM: it makes the command line long enough for that of a program's own child (see `nursery`).

Descriptors that come with an order are the line to the process that bubblewrap waits for, then the program's.
"""

from __future__ import annotations

import gc
import json
import os
import runpy
import select
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from autograder.sandbox.zygote_host import becoming, confinement, leaving, ready
else:
    import becoming
    import confinement
    import leaving
    import ready

MAX_ORDER = 1024 * 1024  # bytes
MAX_FDS = 16
SELF = Path(__file__).parent
ENDING = leaving.Leaving(globals())


def serve(orders: socket.socket) -> dict[str, Any] | None:
    """Fork for each order. Return None when there are no more; in the process of a program, its order.

    An order is received by the child that it is for: a program finds nothing of earlier ones in its memory.
    """
    while True:
        select.select([orders], [], [])
        taken, told = os.pipe()
        if os.fork() == 0:
            data, fds, _, _ = socket.recv_fds(orders, MAX_ORDER, MAX_FDS)
            if not data:
                os._exit(0)
            os.write(told, b"1")
            order: dict[str, Any] = json.loads(data)
            with _reporting(orders):
                if not _attend(orders, order, fds):
                    _confine(orders, order, fds)
                    return order
            os._exit(0)
        os.close(told)
        received = os.read(taken, 1)
        os.close(taken)
        if not received:
            return None
        _reap()


@contextmanager
def _reporting(orders: socket.socket) -> Iterator[None]:
    """Say that this process has failed, and end it: the order is not carried out."""
    try:
        yield
    except BaseException as error:
        orders.send(json.dumps({"failed": f"{type(error).__name__}: {error}"}).encode())
        os._exit(1)


def _reap() -> None:
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def _attend(orders: socket.socket, order: dict[str, Any], fds: list[int]) -> bool:
    """Be the attendant of one program until its end; return at once, and False, in the program's own process."""
    holder = order["holder"]
    if order["group"]:
        (Path(order["group"]) / "cgroup.procs").write_text("0")
    output = os.open(f"/proc/{holder}/fd/2", os.O_WRONLY)
    inner = confinement.join(holder)
    program = os.fork()
    if program == 0:
        os.setsid()
        os.dup2(output, 1)
        os.dup2(output, 2)
        confinement.join_user(inner)
        return False
    orders.send(json.dumps({"program": program}).encode())
    _, status = os.waitpid(program, 0)
    code = os.waitstatus_to_exitcode(status)
    with suppress(BrokenPipeError):  # the sandbox was ended from outside
        os.write(fds[0], b"%d\n" % (code if code >= 0 else 128 - code))
    return True


def _confine(orders: socket.socket, order: dict[str, Any], fds: list[int]) -> None:
    """Give up whatever is left of the outside, the line on which orders come last of all."""
    os.chdir(order["workdir"])
    with socket.socket(fileno=confinement.place(fds[1:], order["fds"], orders.detach())) as kept:
        with _reporting(kept):
            confinement.limit(order["limits"])
            confinement.drop()
        kept.send(b'{"entered": true}')


def main() -> tuple[Any, dict[str, Any]] | None:
    """Serve until there are no more orders, or this is the process of a program."""
    sys.path.remove(str(SELF))
    given = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    base = {path: Path(path).exists() for path in sys.path if path not in given}
    orders = socket.socket(fileno=int(sys.argv[1]))
    preload = runpy.run_path(sys.argv[2])
    ready.make_ready(preload.get("READY", ()), preload.get("warm", lambda: None))
    gc.collect()
    gc.freeze()  # what the programs share is not theirs to look through
    order = serve(orders)
    if order is None:
        return None
    for module in (becoming, confinement, leaving, ready):
        del sys.modules[module.__name__]
    environment = {**order["environment"], "PWD": order["workdir"]}  # bubblewrap tells it, too
    return becoming.become(order["command"], environment, base)


if __name__ == "__main__":
    # The program is run from here, and ends as any does: nothing of the zygote is on its stack but this line.
    if program := main():
        with ENDING:
            exec(*program)
