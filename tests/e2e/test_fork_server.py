"""A program that is forked into its sandbox has the same environment and rights as one that is started there."""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from autograder.ros.environment import WHEEL_BOOTSTRAP_VARIABLES
from autograder.run.sandbox import Limits, Mount, Process, Sandbox, launcher
from autograder.run.sandbox.launcher import launch, warm_up
from autograder.run.sandbox.spec import INTERPRETER
from tests.e2e.sandbox_support import in_worker_sandbox, is_forked

pytestmark = pytest.mark.usefixtures("forks")

TIMEOUT = 120.0  # seconds

# Collects what a process can find out about its environment and its rights.
REPORT = """
import json, os, pathlib, signal, socket, stat, sys, threading

def read(path):
    return pathlib.Path(path).read_text()

def kind(number):
    mode = os.fstat(number).st_mode
    return "pipe" if stat.S_ISFIFO(mode) else "null" if stat.S_ISCHR(mode) else oct(mode)

status = dict(line.split(":", 1) for line in read("/proc/self/status").splitlines())
rights = ("Umask Uid Gid Groups CapInh CapPrm CapEff CapBnd CapAmb NoNewPrivs Seccomp SigBlk SigIgn SigCgt Threads "
          "NSpid").split()
descriptors = [int(name) for name in os.listdir("/proc/self/fd")]
report = {
    "rights": {name: status[name].split() for name in rights},
    "limits": read("/proc/self/limits"),
    "mounts": [line.split()[3:6] + line.split(" - ")[1].split() for line in read("/proc/self/mountinfo").splitlines()],
    "root": sorted(os.listdir("/")),
    "environment": dict(os.environ),
    "descriptors": {n: kind(n) for n in descriptors if os.path.exists(f"/proc/self/fd/{n}")},
    "inheritable": [n for n in descriptors if os.path.exists(f"/proc/self/fd/{n}") and os.get_inheritable(n)],
    "cwd": os.getcwd(),
    "command line": read("/proc/self/cmdline").rstrip("\\0"),
    "grader's modules": [name for name in sys.modules if name.startswith(("autograder", "fork_server"))],
    "host": socket.gethostname(),
    "uid map": read("/proc/self/uid_map").split(),
    "own files": os.access("/proc/self/mem", os.R_OK),
    "leads": os.getsid(0) in (os.getpid(), 1, 2),
    "oom": read("/proc/self/oom_score_adj"),
    "python": {
        "argv": sys.argv, "orig_argv": sys.orig_argv[1:], "path": sys.path, "flags": str(sys.flags), "name": __name__,
        "file": __file__, "executable": sys.executable, "streams": [s.line_buffering for s in (sys.stdin, sys.stdout)],
        "write_through": sys.stdout.write_through, "interrupt": signal.getsignal(signal.SIGINT).__name__,
        "main": sys.modules["__main__"].__dict__ is globals(), "thread": threading.current_thread().name,
    },
}
"""


def program_sandbox(scratch: Path, **options: Any) -> Sandbox:
    """Return the sandbox of a program in a workspace."""
    home = scratch / "home"
    home.mkdir(exist_ok=True)
    ros = {name: os.environ[name] for name in WHEEL_BOOTSTRAP_VARIABLES if name in os.environ}
    variables = {"PATH": "/usr/bin:/bin", "HOME": str(home), "PYTHONPATH": str(home / "modules")}
    return Sandbox(
        home, mounts=(Mount(home, writable=True),), environment={**ros, **INTERPRETER, **variables}, **options
    )


def start(spec: Sandbox, code: str, profile: str | None, *arguments: str, **options: Any) -> Process:
    """Run code as a script: forked from a profile, or started if there is none."""
    script = spec.workdir / "program.py"
    script.write_text(code)
    process = launch([sys.executable, str(script), *arguments], spec, profile=profile, **options)
    assert profile is None or is_forked(process)
    return process


def reports(scratch: Path, network: bool) -> list[Any]:
    """Return the reports of a started and of a forked program, and the namespaces that each shares with the worker."""
    outcomes = []
    for profile in (None, "lockstep"):
        spec = program_sandbox(scratch, network=network)
        code = REPORT + "print(json.dumps(report), flush=True)\nsignal.pause()"
        with start(spec, code, profile, "one", "two") as process:
            while not process.output.endswith("\n") and not process.wait(0.05):
                pass
            worker_namespaces, program_namespaces = (Path(f"/proc/{pid}/ns") for pid in ("self", process.innermost()))
            shared = [
                name.name
                for name in worker_namespaces.iterdir()
                if name.readlink() == (program_namespaces / name.name).readlink()
            ]
            outcomes.append([json.loads(process.output), sorted(shared)])
    return outcomes


@pytest.mark.parametrize("network", [True, False])
def test_a_forked_program_sees_the_same_environment_as_a_started_one(network: bool) -> None:
    (started, started_shared), (forked, shared) = in_worker_sandbox(reports, network)
    assert shared == started_shared
    assert ("net" in shared) is network
    assert not {"mnt", "pid", "user", "ipc", "uts"} & set(shared)
    for report in (started, forked):
        del report["rights"]["NSpid"]  # differs, because bubblewrap's helper processes have numbers, too
        caught_signals = report["rights"].pop("SigCgt")[0]
        # The higher signals are those of the C library's threads.
        assert int(caught_signals, 16) & 0x7FFFFFFF == 1 << signal.SIGINT - 1
    assert forked == started
    assert set(forked["rights"]["CapEff"] + forked["rights"]["CapBnd"]) == {"0" * 16}


LEFT_OPEN = """
import os, pathlib
if os.fork() == 0:
    file = open("left.txt", "w")
    file.write("written at the end")
else:
    os.wait()
    print(pathlib.Path("left.txt").read_text())
"""
DESTROYED = """
import json, sys, types
class Named:
    def __init__(self, name):
        self.name = name
    def __del__(self):
        print(self.name, json and json.dumps([sys is not None, Named is not None]), end="; ")
module = types.ModuleType("mine")
module.held, sys.modules["mine"] = Named("in my module"), module
first, _last = Named("global"), Named("private")
ring = Named("in a ring")
ring.ring, last = ring, Named("last")
print("said", end="; ")
"""
FINALIZER = """
import rclpy, weakref
rclpy.init()
weakref.finalize(rclpy.utilities.get_default_context(), print, "closed").atexit = False
"""
EXITS = {
    "plain": "print('done')",
    "status": "import sys\nprint('out', end='')\nsys.exit(7)",
    "message": "import sys\nsys.exit('too bad')",
    "error": "raise ValueError('nothing')",
    "killed": "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)",
    "fault": "import ctypes\nctypes.string_at(0)",
    "exit": "import os\nprint('gone', flush=True)\nos._exit(3)",
    "at exit": "import atexit\natexit.register(print, 'last')\nprint('first')",
    "threads": "import threading\nthreading.Timer(0.2, print, ['later']).start()",
    "interrupt": "import os, signal\nos.kill(os.getpid(), signal.SIGINT)",
    "negative": "import sys\nsys.exit(-3)",
    "too large": "import sys\nsys.exit(2**70)",
    "true": "import sys\nsys.exit(True)",
    "child's": "import os, sys\nif os.fork() == 0:\n    sys.exit(5)\nsys.exit(os.waitstatus_to_exitcode(os.wait()[1]))",
    "closed output": "import os\nprint('lost')\nos.close(1)",
    "from C": "import ctypes\nctypes.CDLL(None).printf(b'printed')",
    "left open": LEFT_OPEN,
    "destroyed": DESTROYED,
    "finalizer": FINALIZER,
    "node": "import rclpy\nrclpy.init()\nnode = rclpy.create_node('left')\nnode.me = node\nprint(node.get_name())",
    "left behind": "import os, time\nif os.fork() == 0:\n    os.setsid()\n    time.sleep(600)\nprint('over')",
}


def in_any_order(lines: list[str]) -> list[list[str]]:
    """Return the sorted parts of each line, because their order depends on the garbage collector."""
    return [sorted(line.split("; ")) for line in lines]


if sys.version_info >= (3, 13):
    del EXITS["too large"]  # the status is the same, but the last line is another error


def exit_reasons(scratch: Path) -> dict[str, list[Any]]:
    """Return the exit reason, the status and the last line of each program, started and forked."""
    exits: dict[str, list[Any]] = {}
    for name, code in EXITS.items():
        exits[name] = []
        for profile in (None, "tests"):
            with start(program_sandbox(scratch), code, profile) as process:
                assert process.wait(TIMEOUT), name
                assert process.exit_reason is not None
                last = in_any_order(process.output.splitlines()[-1:])
                exits[name].append([process.exit_reason.value, process.returncode, last])
    return exits


def test_a_forked_program_ends_as_a_started_one_does() -> None:
    exits = in_worker_sandbox(exit_reasons)
    assert {name: forked for name, (_, forked) in exits.items()} == {name: s for name, (s, _) in exits.items()}
    assert exits["status"][1] == ["exited", 7, [["out"]]]
    assert len(exits["destroyed"][1][2][0]) == 7
    assert exits["killed"][1][1] == 128 + 9


def outputs(scratch: Path, profile: str, code: str) -> list[str]:
    """Return the output of code in a started and in a forked program."""
    printed = []
    for chosen in (None, profile):
        with start(program_sandbox(scratch), code, chosen) as process:
            assert process.wait(TIMEOUT)
            printed.append(process.output)
    return printed


@pytest.mark.parametrize(
    ("profile", "code"),
    [
        ("tests", "import rclpy\nprint([n for n in dir(rclpy)])\nimport rclpy.node\nprint(dir(rclpy))"),
        ("tests", "import numpy\nprint(dir(numpy))"),
        ("tests", "import pytest\nprint(dir(pytest))"),
        ("tests", "import rclpy\nrclpy.node.Node"),
        ("lockstep", "import sensor_msgs\nsensor_msgs.msg.LaserScan"),
        ("lockstep", "import std_srvs\nstd_srvs.srv"),
        ("tests", "import std_msgs.msg\nstd_msgs.srv"),
        ("tests", "from geometry_msgs.msg import Twist\nimport sensor_msgs\nsensor_msgs.msg"),
        ("launch", "import rclpy\nrclpy.executors"),
        ("launch", "import lifecycle_msgs\nlifecycle_msgs.msg"),
        ("colcon", "import setuptools\nsetuptools.no_such_thing"),
    ],
)
def test_a_missing_import_is_also_missing_in_a_forked_program(profile: str, code: str) -> None:
    started, forked = in_worker_sandbox(outputs, profile, code)
    assert forked.splitlines()[-1] == started.splitlines()[-1]


def test_a_failing_forked_program_prints_the_same_as_a_started_one() -> None:
    code = "def drive(speed):\n    raise ValueError('too fast')\ntry:\n    drive(2)\nfinally:\n    print('over')"
    started, forked = in_worker_sandbox(outputs, "lockstep", code)
    assert forked == started
    assert "Traceback" in forked
    started, forked = in_worker_sandbox(outputs, "lockstep", "this is not valid Python")
    assert forked == started
    assert "SyntaxError" in forked


def shadows(scratch: Path, name: str) -> list[str]:
    """Return the outputs of a started and a forked program whose own module hides another one of this name."""
    package = program_sandbox(scratch).workdir / "modules" / name
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("import sys\nprint('my own', __name__)")
    spec, printed = program_sandbox(scratch), []
    program = spec.workdir / "program.py"
    program.write_text(f"import os, sys\nimport {name}\nprint(sys.argv[1:], os.getcwd()[-4:], sorted(os.environ))")
    for profile in (None, "lockstep"):
        with launch([sys.executable, str(program), "one"], spec, profile=profile) as process:
            assert process.wait(TIMEOUT)
            printed.append(process.output)
    return printed


@pytest.mark.parametrize("name", ["rclpy", "numpy", "std_msgs", "yaml", "selectors", "mine"])
def test_a_students_module_comes_first_on_the_path_of_a_forked_program(name: str) -> None:
    started, forked = in_worker_sandbox(shadows, name)
    assert started.startswith(f"my own {name}\n['one'] home")
    assert forked == started


def random_numbers(scratch: Path) -> list[str]:
    """Return the random numbers of two forked programs."""
    code = "import random, numpy\nprint(random.random(), numpy.random.default_rng().random(), numpy.random.random())"
    return [outputs(scratch, "tests", code)[1] for _ in range(2)]


def test_forked_programs_draw_different_random_numbers() -> None:
    first, second = in_worker_sandbox(random_numbers)
    assert not set(first.split()) & set(second.split())


SEARCH = """
import re, sys
pattern, count = re.compile(sys.argv[1].encode()), 0
with open("/proc/self/maps") as maps, open("/proc/self/mem", "rb") as memory:
    for line in maps:
        span, rights, _, _, inode, *_ = line.split()
        if rights.startswith("rw") and inode == "0":
            start, end = (int(part, 16) for part in span.split("-"))
            memory.seek(start)
            count += len(pattern.findall(memory.read(end - start)))
print(count)
"""


def search_memory(scratch: Path) -> list[str]:
    """Return how often an argument of one program is in its memory, and in the memory of the next program."""
    counts = []
    pattern = "[w]ord-of-mine"  # does not match itself
    for arguments in ([pattern, "word-of-mine " * 4000], [pattern]):
        with start(program_sandbox(scratch), SEARCH, "lockstep", *arguments) as process:
            assert process.wait(TIMEOUT)
            counts.append(process.output)
    return counts


def test_a_forked_program_has_nothing_of_an_earlier_one_in_its_memory() -> None:
    first, second = (int(count) for count in in_worker_sandbox(search_memory))
    assert first >= 1
    assert second == 0


def fork_late(scratch: Path) -> str:
    """Fork from a server that is stopped for longer than the program's time limit; return the exit reason."""
    warm_up("lockstep")
    server = launcher._servers["lockstep"]
    assert server is not None
    os.kill(server.pid, signal.SIGSTOP)
    threading.Timer(2.0, os.kill, [server.pid, signal.SIGCONT]).start()
    spec = program_sandbox(scratch, limits=Limits(wall_seconds=1.0))
    with start(spec, "import signal; signal.pause()", "lockstep") as process:
        process.wait(TIMEOUT)
    assert process.exit_reason is not None
    return process.exit_reason.value


def test_time_that_the_fork_server_needs_does_not_count_for_the_program() -> None:
    assert in_worker_sandbox(fork_late) == "wall_time"


def start_without_profile(scratch: Path) -> list[Any]:
    """Launch twice with a profile that cannot be loaded; return each exit status and output, and the log messages."""
    messages: list[str] = []
    handler = logging.Handler()
    handler.emit = lambda record: messages.append(record.getMessage())  # type: ignore[method-assign]
    logging.getLogger("autograder").addHandler(handler)
    spec, exits = program_sandbox(scratch), []
    (spec.workdir / "program.py").write_text("print('here')")
    for _ in range(2):
        with launch([sys.executable, str(spec.workdir / "program.py")], spec, profile="no such profile") as process:
            assert process.wait(TIMEOUT)
            exits.append([process.returncode, process.output])
    return [exits, messages]


def test_programs_are_started_if_they_cannot_be_forked() -> None:
    exits, messages = in_worker_sandbox(start_without_profile)
    assert exits == [[0, "here\n"]] * 2
    assert len(messages) == 1
    assert messages[0].startswith("programs are started one by one, which takes longer: ")
