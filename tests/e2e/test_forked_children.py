"""A Python program that a forked program starts is also forked, in the same environment as a started one."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from autograder.harness import Workspace
from autograder.harness.launch import LaunchHarness
from autograder.ros import environment
from autograder.run.sandbox import Sandbox
from autograder.run.sandbox.launcher import launch
from tests.e2e.sandbox_support import in_worker_sandbox
from tests.e2e.test_fork_server import ENDS, LONG, REPORT, in_any_order, workplace

pytestmark = pytest.mark.usefixtures("forks")

# Runs the commands in `asked.json`, and prints their outcomes.
PARENT = """
import json, os, subprocess, sys

if "fork_children" in globals():
    fork_children()
found = {}
for name, command, options in json.load(open("asked.json")):
    try:
        done = subprocess.run(command, capture_output=True, text=True, **options)
    except OSError as error:
        found[name] = [repr(error)]
    else:
        found[name] = [done.returncode, done.stdout, done.stderr.splitlines()[-1:]]
print(json.dumps(found))
"""
FAMILY = """
import json, os, pathlib, signal, sys
words = pathlib.Path("/proc/self/cmdline").read_text().rstrip("\\0").split("\\0")
print(json.dumps([
    words, os.getsid(0) == os.getpid(), os.getpgid(0) == os.getpgid(os.getppid()),
    pathlib.Path(f"/proc/{os.getppid()}/cmdline").read_text() != "", signal.getsignal(signal.SIGPIPE).name,
    sys.stdin.read(), os.environ.get("SPEED"), os.environ.get("PWD", "").split("/")[-1], os.getcwd().split("/")[-1],
]))
"""


def program(folder: Path, name: str, code: str, first: str = f"#!{sys.executable}") -> str:
    """Write an executable script; return its path."""
    path = folder / name
    path.write_text(f"{first}\n{code}")
    path.chmod(0o755)
    return str(path)


def both(scratch: Path, asked: list[tuple[str, list[str], dict[str, Any]]], spec: Sandbox) -> list[dict[str, Any]]:
    """Return the outcome of commands that a started and a forked program start."""
    parent = spec.workdir / "parent.py"
    parent.write_text(PARENT)
    (spec.workdir / "asked.json").write_text(json.dumps(asked))
    found = []
    for profile in (None, "launch"):
        with launch([sys.executable, str(parent)], spec, profile=profile) as process:
            assert process.wait(LONG)
            assert process.returncode == 0, process.output
            found.append(json.loads(process.output))
    return found


def reports(scratch: Path) -> list[dict[str, Any]]:
    spec = workplace(scratch)
    (spec.workdir / "below").mkdir()
    report = program(spec.workdir, "report", REPORT + "print(json.dumps(report))")
    family = program(spec.workdir, "family", FAMILY)
    return both(
        scratch,
        [
            ("plain", [report, "one", "two"], {}),
            ("environment", [report], {"env": {**spec.environment, "SPEED": "0.3", "PYTHONPATH": "/tmp"}}),
            ("family", [family, "a" * 3000], {"input": "typed"}),
            ("session", [family, "--flag"], {"input": "", "start_new_session": True, "cwd": "below"}),
            ("by the interpreter", [sys.executable, family], {"input": ""}),
            ("relative", ["../family"], {"input": "", "cwd": "below"}),
            ("no environment", [family], {"input": "", "env": {}}),
        ],
        spec,
    )


def test_a_forked_child_program_sees_the_same_surroundings_as_a_started_one() -> None:
    started, forked = in_worker_sandbox(reports)
    for found in (started, forked):
        for name in ("plain", "environment"):
            report = found[name] = json.loads(found[name][1])
            del report["rights"]["NSpid"], report["rights"]["SigCgt"], report["oom"], report["leads"]
        for name in ("family", "session", "by the interpreter", "relative", "no environment"):
            found[name] = json.loads(found[name][1])
    shown = forked["family"][0]
    assert shown[:2] == started["family"][0][:2]
    assert len("\0".join(shown)) > 1000  # of the three thousand there is room for this many
    assert started["family"][0].pop(2).startswith(shown.pop(2))
    assert forked == started
    assert forked["session"][1:3] == [True, False]
    assert forked["family"][5] == "typed"


def exit_reasons(scratch: Path) -> list[dict[str, Any]]:
    spec = workplace(scratch)
    codes = {name: code for name, code in ENDS.items() if name != "left behind"}  # its output never ends
    asked = [(name, [program(spec.workdir, name, code)], {}) for name, code in codes.items()]
    no_rights = spec.workdir / "no rights"
    no_rights.write_text(f"#!{sys.executable}")
    return both(
        scratch,
        [
            *((name, command, {}) for name, command, _ in asked),
            ("is not there", [str(spec.workdir / "nothing")], {}),
            ("may not", [str(no_rights)], {}),
            ("nowhere", [asked[0][1][0]], {"cwd": "no/such/folder"}),
            ("another interpreter", [program(spec.workdir, "shell", "echo $0", "#!/bin/sh")], {}),
            ("an option", [program(spec.workdir, "option", "import sys\nprint(sys.flags.isolated)", _ISOLATED)], {}),
            ("a variable", [program(spec.workdir, "flags", "import sys\nprint(sys.flags.optimize)")], {"env": _PLAIN}),
            ("by name", ["true"], {}),
            ("by a name that is only here", ["plain"], {}),
            ("a shell's", "echo shell", {"shell": True}),
        ],
        spec,
    )


_ISOLATED = f"#!{sys.executable} -I"
_PLAIN = {"PATH": os.defpath, "PYTHONOPTIMIZE": "2"}


def test_a_forked_child_program_ends_as_a_started_one_does() -> None:
    started, forked = in_worker_sandbox(exit_reasons)
    for found in (started, forked):
        found["destroyed"] = in_any_order(found["destroyed"][1:2])
    assert forked == started
    assert forked["status"] == [7, "out", []]
    assert forked["killed"][0] == -signal.SIGKILL
    assert "FileNotFoundError" in forked["is not there"][0]
    assert forked["a variable"][1] == "2\n"


LAUNCHED = """
import signal, sys
print("forked" if "rclpy" in sys.modules else "started", "launch" in sys.modules, sys.argv[1:2], flush=True)
signal.pause()
"""
LAUNCH_FILE = """
from launch import LaunchDescription
from launch.actions import ExecuteProcess
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="pkg", executable="waits", name="one", output="screen"),
        Node(package="pkg", executable="waits", name="two", output="screen", emulate_tty=True),
        ExecuteProcess(cmd=["sh", "-c", "echo shell; exec sleep 600"], output="screen"),
    ])
"""


def launched(scratch: Path) -> list[Any]:
    """Return what a launch says, which programs run, how it ends on Ctrl-C, and what it leaves."""
    prefix = scratch / "ws" / "install" / "pkg"
    for folder in ("share/ament_index/resource_index/packages", "share/pkg/launch", "lib/pkg"):
        (prefix / folder).mkdir(parents=True)
    (prefix / "share/ament_index/resource_index/packages/pkg").touch()
    (prefix / "share/pkg/launch/both.launch.py").write_text(LAUNCH_FILE)
    program(prefix / "lib/pkg", "waits", LAUNCHED)
    workspace = Workspace(scratch / "ws", environment.find(), scratch / "home")
    workspace.scratch.mkdir()
    with LaunchHarness(workspace, "pkg", "both.launch.py") as harness:
        harness.wait_for(lambda: harness.output.count("forked") == 2 and "shell" in harness.output, LONG)
        running = [[found.package, found.name] for found in harness.programs()]
        killed = harness.kill("waits", signal.SIGKILL)
        harness.wait_for(lambda: harness.output.count("died") == 2, LONG)
        stop = harness.interrupt(LONG)
        return [harness.output, running, killed, stop.status, list(stop.left)]


def test_programs_of_a_launch_are_forked_and_listed_by_name() -> None:
    output, running, killed, status, left = in_worker_sandbox(launched)
    assert output.count("forked False ['--ros-args']") == 2, output
    assert running == [["pkg", "waits"]] * 2
    assert killed == 2
    assert output.count("exit code -9") == 2
    assert (status, left) == (0, [])
