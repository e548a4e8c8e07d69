"""The limits of code in a sandbox, started or forked: files, network, processes and resources."""

from __future__ import annotations

import ast
import json
import os
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autograder.doctor import security
from autograder.doctor.escapes import CANARY, ESCAPES
from autograder.exceptions import GraderError
from autograder.run.fork_server import seccomp
from autograder.run.sandbox import ExitReason, Isolation, Limits, Mount, Process, Sandbox, cgroup, procfs
from autograder.run.sandbox.launcher import launch, warm_up
from autograder.run.sandbox.limits import GIB, MIB
from tests.e2e.sandbox_support import ROOT, in_worker_sandbox, is_forked, started_in_worker_sandbox

SMALL = {"wall_seconds": 60.0, "threads": 40, "memory": 200 * MIB, "output": 50_000, "scratch": 4 * MIB}


START_METHOD_VARIABLE = "AUTOGRADER_TEST_START_METHOD"


@pytest.fixture(params=("started", "forked"), autouse=True)
def start_method(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """How programs get into their sandbox. Code in a worker sandbox reads it from the environment."""
    if request.param == "forked":
        request.getfixturevalue("forks")
    monkeypatch.setenv(START_METHOD_VARIABLE, request.param)
    return str(request.param)


def run(code: str, spec: Sandbox) -> Process:
    """Run code in a sandbox, by the start method of the current test."""
    if os.environ[START_METHOD_VARIABLE] == "started":
        return launch([sys.executable, "-I", "-c", code], spec)
    program = spec.workdir / ".program.py"
    program.write_text(code)
    process = launch([sys.executable, str(program)], spec, profile="lockstep")
    assert is_forked(process)
    return process


def run_to_its_end(scratch: Path, code: str, limits: dict[str, Any], network: bool = False) -> dict[str, Any]:
    """Run code in a sandbox with a writable home; return how it ended, its output and the processes that it left."""
    home = scratch / "home"
    home.mkdir()
    spec = Sandbox(home, mounts=(Mount(home, writable=True),), network=network, limits=Limits(**limits))
    if os.environ[START_METHOD_VARIABLE] == "forked":
        warm_up("lockstep")
    before = security.processes()
    with run(code, spec) as process:
        process.wait(limits["wall_seconds"] + 60)
        exit_reason = process.exit_reason
    deadline = time.monotonic() + 30
    while (remaining := security.processes() - before) and time.monotonic() < deadline:
        threading.Event().wait(0.05)
    assert exit_reason is not None
    return {
        "exit_reason": exit_reason.value,
        "status": process.returncode,
        "output": process.output,
        "remaining": sorted(remaining),
    }


def _run(code: str, *, network: bool = False, **limits: Any) -> dict[str, Any]:
    answer: dict[str, Any] = in_worker_sandbox(run_to_its_end, code, {**SMALL, **limits}, network)
    assert answer["remaining"] == []
    return answer


def attempt_escape(scratch: Path, name: str, port: int) -> str:
    """Attempt an escape from a sandbox in this worker sandbox; return what it reached."""
    os.environ["CANARY"] = CANARY
    profile = "lockstep" if os.environ[START_METHOD_VARIABLE] == "forked" else None
    if profile:
        warm_up(profile)
    return security.attempt(next(escape for escape in ESCAPES if escape.id == name), scratch, port, profile)


def _reached(*names: str) -> list[str]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return [
            result for name in names if (result := in_worker_sandbox(attempt_escape, name, server.getsockname()[1]))
        ]


@pytest.mark.promise("sandbox that has no network and cannot see the checks")
def test_no_file_process_or_memory_of_the_grader_can_be_read() -> None:
    assert _reached("files", "processes", "memory") == []


def test_the_system_is_read_only_and_what_is_writable_is_limited() -> None:
    assert _reached("writing", "settings", "disk") == []


def test_a_sandbox_cannot_exhaust_limits_of_the_kernel_per_user() -> None:
    assert _reached("inotify", "descriptors") == []


def can_pass_a_descriptor_under_load(scratch: Path) -> bool:
    """Let a sandboxed program keep its maximum of descriptors in flight; return whether this process can pass one."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (1024, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))  # the usual limit
    code = "import signal\n" + next(escape.code for escape in ESCAPES if escape.id == "descriptors")
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    with run(f"{code}\nprint('full', flush=True)\n{ENDLESS}", spec) as process:
        _until(lambda: "full" in process.output)
        near, far = socket.socketpair()
        with near, far:
            socket.send_fds(near, [b"x"], [0])
            return socket.recv_fds(far, 1, 1)[0] == b"x"


def test_a_worker_can_pass_descriptors_while_a_program_keeps_its_maximum_in_flight() -> None:
    assert in_worker_sandbox(can_pass_a_descriptor_under_load)


def test_a_large_file_is_cut_off() -> None:
    code = "import signal, os\nsignal.signal(signal.SIGXFSZ, signal.SIG_IGN)\nopen('big', 'wb').write(bytes(3 << 20))"
    answer = _run(code, file_size=MIB)
    assert "File too large" in answer["output"]


@pytest.mark.promise(
    "sandbox that has no network and cannot see the checks",
    "Students' code cannot read it: the sandbox has neither the network nor that folder.",
)
def test_a_program_without_a_network_reaches_nothing() -> None:
    assert _reached("network", "loopback") == []


def connect_to_loopback(scratch: Path, code: str) -> dict[str, bool]:
    """Listen on the loopback address; return whether sandboxed code can connect with and without a network."""
    answers = {}
    for network in (True, False):
        (scratch / str(network)).mkdir()
        with socket.create_server(("127.0.0.1", 0)) as server:
            ready = code.replace("PORT", str(server.getsockname()[1]))
            answers[str(network)] = "REACHED" in run_to_its_end(scratch / str(network), ready, SMALL, network)["output"]
    return answers


def test_a_node_reaches_the_loopback_of_the_worker_sandbox_and_a_build_does_not() -> None:
    code = "import socket\nsocket.create_connection(('127.0.0.1', PORT), timeout=5)\nprint('REACHED')"
    assert in_worker_sandbox(connect_to_loopback, code) == {"True": True, "False": False}


BOUNDED = pytest.mark.skipif(
    "pids" not in cgroup.bounds(), reason="root without control groups: a fork bomb stops the machine"
)
ENDLESS = "import signal\nwhile True: signal.pause()"
MARKS = {
    "fork bomb": BOUNDED,
    "socket buffers": pytest.mark.skipif("memory" not in cgroup.bounds(), reason="no control group counts memory here"),
}
UNBOUNDED = ("unmapped memory", *(e.id for e in ESCAPES if e.exit_reasons != (ExitReason.EXITED,)), "daemon")


@pytest.mark.parametrize("name", [pytest.param(name, marks=MARKS.get(name, ())) for name in UNBOUNDED])
def test_each_program_that_exceeds_a_limit_is_ended_and_leaves_nothing(name: str) -> None:
    assert _reached(name) == []


def test_neither_the_grader_nor_anything_outside_can_be_signalled_or_traced() -> None:
    assert _reached("signals", "memory") == []


@pytest.mark.promise("With `--isolation process` it has both", "students' code could then read the checks")
@pytest.mark.parametrize("start_method", ["started"], indirect=True)
@pytest.mark.parametrize("name", ["files", "processes", "network", "unmapped memory"])
def test_without_a_sandbox_the_same_programs_escape(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CANARY", CANARY)
    code = next(escape.program for escape in ESCAPES if escape.id == name)
    with socket.create_server(("127.0.0.1", 0)) as server:
        constants = f"PORT, OUTSIDE = {server.getsockname()[1]}, {os.getpid()}\n"
        process = subprocess.run([sys.executable, "-c", constants + code], capture_output=True, text=True, check=True)
    assert process.stdout.startswith("OUT")


def test_system_calls_that_no_node_needs_fail_and_those_that_programs_need_work() -> None:
    code = f"""
import ctypes, errno, socket, subprocess, sys, threading
libc = ctypes.CDLL(None, use_errno=True)
def fails(number, *arguments):
    return libc.syscall(number, *arguments) == -1 and ctypes.get_errno() == errno.ENOSYS
print([name for name, number in {seccomp.FORBIDDEN}.items() if not fails(number, 0, 0, 0, 0, 0)])
print(fails({seccomp.CLONE}, 1 << 28, 0, 0, 0, 0), fails({1 << 30} + 39))
print({{f for f in range(46) if not fails({seccomp.SOCKET}, f, socket.SOCK_STREAM, 0)}})
thread = threading.Thread(target=print, args=("a thread",))
thread.start(); thread.join()
print(subprocess.run([sys.executable, "-Ic", "print('a program')"], capture_output=True, text=True).stdout.strip())
"""
    expected = ["[]", "True True", str(set(map(int, seccomp.FAMILIES))), "a thread", "a program"]
    assert _reached("calls") == []
    assert _run(code)["output"].splitlines() == expected


def start_with_missing_mounts(scratch: Path) -> list[str]:
    """Start programs in sandboxes whose mounts are missing, as after a system's update; return the errors."""
    errors = []
    for name in ("gone", "beside"):
        spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True), Mount(scratch / name)))
        with launch([sys.executable, "-c", "pass"], spec) as process, pytest.raises(GraderError) as excinfo:
            process.wait(10)
        errors.append(str(excinfo.value))
    return errors


def imitate_bubblewrap(scratch: Path) -> list[Any]:
    """Run a program that ends as bubblewrap does if it cannot make a sandbox; return its status and output."""
    code = "import os, sys; print('bwrap: No such file:', os.listdir('/proc/self/fd')); sys.exit(1)"
    with run(code, Sandbox(scratch, mounts=(Mount(scratch, writable=True),))) as process:
        process.wait(10)
        return [process.returncode, process.output]


def test_a_sandbox_that_cannot_be_created_is_not_a_failure_of_the_program() -> None:
    for error in in_worker_sandbox(start_with_missing_mounts):
        assert re.match("The sandbox could not be made: bwrap: Can't find source path /.*: No such file", error), error


def test_a_program_cannot_pretend_that_its_sandbox_was_not_made() -> None:
    status, output = in_worker_sandbox(imitate_bubblewrap)
    descriptors = set(ast.literal_eval(output.partition("file: ")[2].strip()))
    assert (status, descriptors - {"0", "1", "2", "3"}) == (1, set()), output  # 3 is the folder that it lists


def signal_program(scratch: Path, code: str) -> list[Any]:
    """Send SIGTERM to a sandboxed program; return whether it ended, its status and its output."""
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


def test_a_signal_reaches_the_students_process_and_its_status_is_returned() -> None:
    code = """
import os, signal, sys
def end(*_):
    os.write(1, b"handled\\n")
    sys.exit(7)
signal.signal(signal.SIGTERM, end)
os.write(1, b"up\\n")  # print would write the line's end separately: the signal could come in between
while True: signal.pause()
"""
    assert in_worker_sandbox(signal_program, code) == [True, 7, "up\nhandled\n"]


def run_endless_program(scratch: Path) -> list[str]:
    """Start a sandboxed program, and wait until this process is killed."""
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    process = run("print('up', flush=True)\n" + ENDLESS, spec)
    _until(lambda: "up" in process.output)
    print("running", flush=True)
    signal.pause()
    return []


def control_groups(scratch: Path) -> str:
    """Return the control groups of a sandboxed program, with the names that they have outside."""
    spec = Sandbox(scratch, mounts=(Mount(scratch, writable=True),))
    with run("print('up', flush=True)\n" + ENDLESS, spec) as process:
        _until(lambda: "up" in process.output)
        return Path(f"/proc/{process.innermost()}/cgroup").read_text()


@pytest.mark.skipif(os.geteuid() != 0, reason="prlimit limits every user except root")
@BOUNDED
def test_the_kernel_counts_the_processes_of_a_sandbox_of_root() -> None:
    assert "/autograder-" in in_worker_sandbox(control_groups)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root has control groups of its own")
@BOUNDED
@pytest.mark.parametrize("start_method", ["started"], indirect=True)  # the weak isolation level has no other
def test_the_weak_isolation_level_ends_a_fork_bomb_of_root() -> None:
    code = "import os\nwhile True:\n    try: os.fork()\n    except OSError: pass"
    before = _bombs(code)
    answer = in_worker_sandbox(run_to_its_end, code, {**SMALL, "memory": 4 * GIB}, True, isolation=Isolation.PROCESS)
    assert answer["exit_reason"] == ExitReason.THREADS.value
    assert _bombs(code) <= before


def _bombs(code: str) -> set[int]:
    pids = set()
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if code.encode() in Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0"):
                pids.add(int(pid))
        except OSError:
            continue
    return pids


def test_when_a_worker_is_killed_its_sandboxes_die_with_it() -> None:
    with started_in_worker_sandbox(run_endless_program) as process:
        _until(lambda: "running" in process.output)
        tree = procfs.measure(process.pid).pids
        worker = next(pid for pid in tree if procfs.name(pid).startswith("python"))
        below = set(procfs.measure(worker).pids)
        assert len(below) > 1
        os.kill(worker, signal.SIGKILL)
        _until(lambda: not any(Path(f"/proc/{pid}/exe").exists() for pid in below))


ORDINARY = 4711  # a user id without a name


@pytest.mark.skipif(
    os.geteuid() != 0 or not shutil.which("setpriv"), reason="only root can run a command as another user"
)
@pytest.mark.parametrize("start_method", ["started"], indirect=True)  # the doctor tries both
def test_sandboxes_of_an_ordinary_user_block_the_same_escapes_as_those_of_root() -> None:
    """The exception is an escape that only a control group blocks, if an ordinary user cannot make one."""
    if not all(path.stat().st_mode & 1 for path in (Path(__file__), *Path(__file__).parents) if path.is_dir()):
        pytest.skip("an ordinary user cannot read this folder")
    home = Path(tempfile.mkdtemp(dir="/tmp"))
    os.chown(home, ORDINARY, ORDINARY)
    user = ["setpriv", f"--reuid={ORDINARY}", f"--regid={ORDINARY}", "--clear-groups", "--no-new-privs", "env"]
    command = [sys.executable, "-m", "autograder", "doctor", "--security", "--json", str(home / "escapes.json")]
    try:
        subprocess.run([*user, f"HOME={home}", f"TMPDIR={home}", *command], cwd=ROOT, capture_output=True, check=False)
        statuses = {row["name"]: row["status"] for row in json.loads((home / "escapes.json").read_text())}
        assert list(home.glob("autograder-worker-*")) == []
    finally:
        shutil.rmtree(home)
    assert {*statuses} == {escape.id for escape in ESCAPES}
    assert {name for name, status in statuses.items() if status != "ok"} <= {"socket buffers"}
