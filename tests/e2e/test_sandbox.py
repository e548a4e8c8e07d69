"""The sandbox in a cell, for real: what code in it sees, reaches and leaves, started there or forked into it."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder import layout
from autograder.prefork import seccomp
from autograder.sandbox import Ending, Limits, Mount, Process, Sandbox, Tier, cgroup
from autograder.sandbox.launcher import launch, warm_up
from autograder.sandbox.limits import GIB, MIB
from tests.e2e.cell_support import in_cell, is_forked

SMALL = {"wall_seconds": 60.0, "threads": 40, "memory": 200 * MIB, "output": 50_000, "scratch": 4 * MIB}


WAY = "SANDBOX_WAY"
WAYS = ("started", "forked")


@pytest.fixture(params=WAYS, autouse=True)
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How a program comes into its sandbox; whoever is in a cell learns it from the environment."""
    if request.param == "forked":
        request.getfixturevalue("forks")
    monkeypatch.setenv(WAY, request.param)
    return str(request.param)


def run(code: str, spec: Sandbox) -> Process:
    """Run code as a program in a sandbox, in the way that this test is about."""
    if os.environ[WAY] == "started":
        return launch([sys.executable, "-I", "-c", code], spec)
    program = spec.workdir / ".program.py"
    program.write_text(code)
    process = launch([sys.executable, str(program)], spec, profile="lockstep")
    assert is_forked(process)
    return process


def inside(scratch: Path, code: str, limits: dict[str, Any], network: bool = False) -> dict[str, Any]:
    """Run code in a sandbox whose workdir is a writable home; say how it ended, and what is left of it."""
    home = scratch / "home"
    home.mkdir()
    spec = Sandbox(home, mounts=(Mount(home, writable=True),), network=network, limits=Limits(**limits))
    if os.environ[WAY] == "forked":
        warm_up("lockstep")
    before = _processes()
    with run(code, spec) as process:
        process.wait(limits["wall_seconds"] + 60)
        ending = process.ending
    deadline = time.monotonic() + 30
    while (left := _processes() - before) and time.monotonic() < deadline:
        threading.Event().wait(0.05)
    assert ending is not None
    return {"ending": ending.value, "status": process.returncode, "output": process.output, "left": sorted(left)}


def _processes() -> set[str]:
    """Return the processes of this cell's network namespace; nobody else is in it."""
    here = Path("/proc/self/ns/net").readlink()
    found = set()
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if Path(f"/proc/{pid}/ns/net").readlink() == here and int(pid) != os.getpid():
                state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
                found.add(f"{pid} {state}")
        except OSError:
            continue
    return {entry.split()[0] for entry in found if entry.split()[1] not in "ZX"}


def _run(code: str, *, network: bool = False, **limits: Any) -> dict[str, Any]:
    answer: dict[str, Any] = in_cell(inside, code, {**SMALL, **limits}, network)
    assert answer["left"] == []
    return answer


def test_nothing_of_the_grader_or_the_machine_can_be_read() -> None:
    secrets = [
        *map(str, (layout.CHECKS, layout.SOLUTIONS, layout.ROOT / "autograder", layout.ROOT / "pyproject.toml")),
        *("/root/.bashrc", "/root/.ssh", "/home", "/etc/shadow", "/etc/passwd", "/var", "/run", "/sys", "/boot"),
    ]
    code = f"""
import glob, os
for path in {secrets!r}:
    if os.path.exists(path):
        print("SEEN", path)
for environ in glob.glob("/proc/[0-9]*/environ"):
    if b"CANARY" in open(environ, "rb").read():
        print("SEEN", environ)
print("processes", len(glob.glob("/proc/[0-9]*")))
print(sorted(os.environ))
print("fds", sorted(os.listdir("/proc/self/fd")))
"""
    os.environ["CANARY"] = "of the grader's environment"
    try:
        answer = _run(code)
    finally:
        del os.environ["CANARY"]
    assert "SEEN" not in answer["output"]
    seen = answer["output"].splitlines()
    assert int(seen[-3].split()[1]) <= 3  # bubblewrap, itself, at most one helper
    assert "HOME" not in seen[-2]
    assert "CANARY" not in seen[-2]
    assert seen[-1] == "fds ['0', '1', '2', '3']"  # 3 is the listing itself


def test_the_system_is_read_only_and_what_is_writable_is_limited() -> None:
    code = """
import os
for folder in ("/", "/usr", "/etc", "/dev", "/proc", "/tmp", "/dev/shm", os.getcwd()):
    try:
        open(folder + "/probe", "w").close()
        print("writable", folder)
    except OSError:
        pass
def fill(folder):
    written = 0
    try:
        for number in range(100):
            with open(f"{folder}/{number}", "wb", buffering=0) as stream:
                written += stream.write(bytes(1 << 20))
    except OSError as error:
        return written >> 20, error.strerror
    return written >> 20, "no limit"
print(fill("/tmp"))
print(fill("/dev/shm"))
"""
    lines = _run(code)["output"].splitlines()
    assert [line.split()[1] for line in lines if line.startswith("writable")][:2] == ["/tmp", "/dev/shm"]
    assert len([line for line in lines if line.startswith("writable")]) == 3
    assert lines[-2:] == ["(4, 'No space left on device')"] * 2


def test_a_large_file_is_cut_off() -> None:
    code = "import signal, os\nsignal.signal(signal.SIGXFSZ, signal.SIG_IGN)\nopen('big', 'wb').write(bytes(3 << 20))"
    answer = _run(code, file_size=MIB)
    assert "File too large" in answer["output"]


@pytest.mark.parametrize("network", [False, True])
def test_there_is_no_way_out_to_any_network(network: bool) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        code = f"""
import os, socket
print(sorted(name for _, name in socket.if_nameindex()))
for address in (("127.0.0.1", {port}), ("1.1.1.1", 53), ("192.168.0.1", 80)):
    try:
        socket.create_connection(address, timeout=3)
        print("REACHED", address)
    except OSError:
        pass
"""
        output = _run(code, network=network)["output"]
    assert "REACHED" not in output
    assert output.splitlines()[0] == "['lo']"


def meets(scratch: Path, code: str) -> dict[str, bool]:
    """Listen on the cell's loopback, and let sandboxed code with and without a network try to come."""
    answers = {}
    for network in (True, False):
        (scratch / str(network)).mkdir()
        with socket.create_server(("127.0.0.1", 0)) as server:
            ready = code.replace("PORT", str(server.getsockname()[1]))
            answers[str(network)] = "REACHED" in inside(scratch / str(network), ready, SMALL, network)["output"]
    return answers


def test_a_node_reaches_the_cell_s_loopback_and_a_build_does_not() -> None:
    code = "import socket\nsocket.create_connection(('127.0.0.1', PORT), timeout=5)\nprint('REACHED')"
    assert in_cell(meets, code) == {"True": True, "False": False}


BOUNDED = pytest.mark.skipif(
    "pids" not in cgroup.bounds(), reason="root without control groups: a fork bomb stops the machine"
)
NEW_NAMESPACES = [1 << bit for bit in range(32) if seccomp._NEW_NAMESPACES >> bit & 1]
ENDLESS = "import signal\nwhile True: signal.pause()"


@pytest.mark.parametrize(
    ("code", "limits", "ending"),
    [
        pytest.param(
            "import os\nwhile True:\n    try: os.fork()\n    except OSError: pass",
            {"memory": 4 * GIB},
            Ending.THREADS,
            marks=BOUNDED,
            id="fork bomb",
        ),
        pytest.param(
            "import threading\nwhile True: threading.Thread(target=threading.Event().wait).start()",
            {},
            Ending.THREADS,
            id="thread bomb",
        ),
        pytest.param(
            "held = []\nwhile True: held.append(bytearray(b'x') * (1 << 20))", {}, Ending.MEMORY, id="memory eater"
        ),
        pytest.param(
            "import itertools\nfor n in itertools.count(): open(f'/tmp/{n}', 'w').close()", {}, Ending.FILES, id="files"
        ),
        pytest.param("while True: print('x' * 99)", {}, Ending.OUTPUT, id="endless output"),
        pytest.param("while True: pass", {"wall_seconds": 1.0}, Ending.WALL_TIME, id="endless loop"),
        pytest.param(
            "import signal\nfor n in range(1, 65):\n    try: signal.signal(n, signal.SIG_IGN)\n"
            "    except (OSError, ValueError): pass\nwhile True: signal.pause()",
            {"wall_seconds": 1.0},
            Ending.WALL_TIME,
            id="ignores every signal",
        ),
        pytest.param(
            "import os\nfor _ in range(2):\n    if os.fork(): os._exit(0)\n    os.setsid()\n" + ENDLESS,
            {},
            Ending.EXITED,
            id="daemon by setsid and two forks",
        ),
    ],
)
def test_each_way_to_run_wild_is_ended_and_leaves_nothing(code: str, limits: dict[str, Any], ending: Ending) -> None:
    assert _run(code, **limits)["ending"] == ending.value


def test_neither_the_grader_nor_anything_outside_can_be_signalled_or_traced() -> None:
    outside = os.getpid()
    code = f"""
import ctypes, os, signal
for pid in ({outside}, os.getppid(), -1):
    try:
        os.kill(pid, signal.SIGSTOP if pid > 1 else 0)
        print("signalled", pid)
    except OSError as error:
        print("cannot", pid, error.strerror)
print("ptrace", ctypes.CDLL(None).ptrace(16, {outside}, 0, 0))
"""
    answer = _run(code)
    assert f"cannot {outside} No such process" in answer["output"]
    assert "ptrace -1" in answer["output"]


def test_calls_that_no_node_needs_are_unknown_and_what_programs_live_by_works() -> None:
    code = f"""
import ctypes, errno, os, socket, subprocess, sys, threading
libc = ctypes.CDLL(None, use_errno=True)
def fails(number, *arguments):
    return libc.syscall(number, *arguments) == -1 and ctypes.get_errno() == errno.ENOSYS
print([name for name, number in {seccomp._FORBIDDEN}.items() if not fails(number, 0, 0, 0, 0, 0)])
print([flag for flag in {NEW_NAMESPACES} if not fails({seccomp._CLONE}, flag | 17, 0, 0, 0, 0)])
print(fails({seccomp._X32} + 39), {{f for f in range(46) if not fails({seccomp._SOCKET}, f, socket.SOCK_STREAM, 0)}})
thread = threading.Thread(target=print, args=("a thread",))
thread.start(); thread.join()
print(subprocess.run([sys.executable, "-Ic", "print('a program')"], capture_output=True, text=True).stdout.strip())
"""
    wanted = ["[]", "[]", f"True {set(map(int, seccomp._FAMILIES))}", "a thread", "a program"]
    assert _run(code)["output"].splitlines() == wanted


def signalled(scratch: Path, code: str) -> list[Any]:
    """Send SIGTERM to a sandboxed program that is up; say its status and whether its handler ran."""
    home = scratch / "home"
    home.mkdir()
    with run(code, Sandbox(home, mounts=(Mount(home, writable=True),))) as process:
        _until(lambda: "up" in process.output)
        process.signal(signal.SIGTERM)
        return [process.wait(60), process.returncode, process.output]


def _until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < deadline
        threading.Event().wait(0.02)


def test_a_signal_reaches_the_student_s_own_process_and_its_status_comes_back() -> None:
    code = """
import os, signal, sys
def end(*_):
    os.write(1, b"handled\\n")
    sys.exit(7)
signal.signal(signal.SIGTERM, end)
os.write(1, b"up\\n")  # not print, which writes the end of the line apart: the signal could come in between
while True: signal.pause()
"""
    assert in_cell(signalled, code) == [True, 7, "up\nhandled\n"]


def killed(scratch: Path) -> list[str]:
    """Start a sandboxed program and end without any clean-up, as a worker does that is killed."""
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    process = run("print('up', flush=True)\n" + ENDLESS, spec)
    _until(lambda: "up" in process.output)
    print(f"answer: {os.getpid()} {process.innermost()}", flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
    return []


def group_of(scratch: Path) -> str:
    """Return the control groups of a sandboxed program, as the machine names them."""
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    with run("print('up', flush=True)\n" + ENDLESS, spec) as process:
        _until(lambda: "up" in process.output)
        return Path(f"/proc/{process.innermost()}/cgroup").read_text()


@pytest.mark.skipif(os.geteuid() != 0, reason="prlimit bounds everybody but root")
@BOUNDED
def test_the_processes_of_root_s_sandbox_are_counted_by_the_kernel() -> None:
    assert "/autograder-" in in_cell(group_of)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root has control groups of its own")
@BOUNDED
@pytest.mark.parametrize("way", ["started"], indirect=True)  # the weak tier knows no other
def test_not_even_the_weak_tier_leaves_root_a_fork_bomb() -> None:
    code = "import os\nwhile True:\n    try: os.fork()\n    except OSError: pass"
    before = _bombs(code)
    answer = in_cell(inside, code, {**SMALL, "memory": 4 * GIB}, True, tier=Tier.PROCESS)
    assert answer["ending"] == Ending.THREADS.value
    assert _bombs(code) <= before


def _bombs(code: str) -> set[int]:
    found = set()
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if code.encode() in Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0"):
                found.add(int(pid))
        except OSError:
            continue
    return found


def test_when_a_worker_is_killed_its_sandboxes_die_with_it() -> None:
    with pytest.raises(AssertionError, match="answer: ") as caught:
        in_cell(killed, own_cell=True)
    pids = str(caught.value).partition("answer: ")[2].split()[:2]
    for pid in pids:
        _until(lambda pid=pid: not Path(f"/proc/{pid}").exists())  # type: ignore[misc]
