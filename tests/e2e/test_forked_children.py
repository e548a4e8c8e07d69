"""Python programs that a forked program starts are also forked, with the environment of started ones."""

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
from tests.e2e.test_fork_server import EXITS, REPORT, TIMEOUT, in_any_order, program_sandbox

pytestmark = pytest.mark.usefixtures("forks")

# Runs the commands in `commands.json` and prints their outcomes.
PARENT = """
import json, os, subprocess, sys

if "fork_children" in globals():
    fork_children()
outcomes = {}
for name, command, options in json.load(open("commands.json")):
    try:
        done = subprocess.run(command, capture_output=True, text=True, **options)
    except OSError as error:
        outcomes[name] = [repr(error)]
    else:
        outcomes[name] = [done.returncode, done.stdout, done.stderr.splitlines()[-1:]]
print(json.dumps(outcomes))
"""
FAMILY = """
import json, os, pathlib, signal, sys
arguments = pathlib.Path("/proc/self/cmdline").read_text().rstrip("\\0").split("\\0")
print(json.dumps([
    arguments, os.getsid(0) == os.getpid(), os.getpgid(0) == os.getpgid(os.getppid()),
    pathlib.Path(f"/proc/{os.getppid()}/cmdline").read_text() != "", signal.getsignal(signal.SIGPIPE).name,
    sys.stdin.read(), os.environ.get("SPEED"), os.environ.get("PWD", "").split("/")[-1], os.getcwd().split("/")[-1],
]))
"""


def program(folder: Path, name: str, code: str, shebang: str = f"#!{sys.executable}") -> str:
    """Write an executable script; return its path."""
    path = folder / name
    path.write_text(f"{shebang}\n{code}")
    path.chmod(0o755)
    return str(path)


def run_both(
    scratch: Path, commands: list[tuple[str, list[str] | str, dict[str, Any]]], spec: Sandbox
) -> list[dict[str, Any]]:
    """Return the outcomes of commands that are run by a started and by a forked program."""
    parent = spec.workdir / "parent.py"
    parent.write_text(PARENT)
    (spec.workdir / "commands.json").write_text(json.dumps(commands))
    outcomes = []
    for profile in (None, "launch"):
        with launch([sys.executable, str(parent)], spec, profile=profile) as process:
            assert process.wait(TIMEOUT)
            assert process.returncode == 0, process.output
            outcomes.append(json.loads(process.output))
    return outcomes


def reports(scratch: Path) -> list[dict[str, Any]]:
    spec = program_sandbox(scratch)
    (spec.workdir / "below").mkdir()
    report = program(spec.workdir, "report", REPORT + "print(json.dumps(report))")
    family = program(spec.workdir, "family", FAMILY)
    return run_both(
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


def test_a_forked_child_program_sees_the_same_environment_as_a_started_one() -> None:
    started, forked = in_worker_sandbox(reports)
    for outcomes in (started, forked):
        for name in ("plain", "environment"):
            report = outcomes[name] = json.loads(outcomes[name][1])
            del report["rights"]["NSpid"], report["rights"]["SigCgt"], report["oom"], report["leads"]
        for name in ("family", "session", "by the interpreter", "relative", "no environment"):
            outcomes[name] = json.loads(outcomes[name][1])
    arguments = forked["family"][0]
    assert arguments[:2] == started["family"][0][:2]
    assert len("\0".join(arguments)) > 1000  # a forked process has no room for all 3,000 characters
    assert started["family"][0].pop(2).startswith(arguments.pop(2))
    assert forked == started
    assert forked["session"][1:3] == [True, False]
    assert forked["family"][5] == "typed"


def exit_reasons(scratch: Path) -> list[dict[str, Any]]:
    spec = program_sandbox(scratch)
    codes = {name: code for name, code in EXITS.items() if name != "left behind"}  # its output never ends
    programs = {name: program(spec.workdir, name, code) for name, code in codes.items()}
    no_rights = spec.workdir / "no rights"
    no_rights.write_text(f"#!{sys.executable}")
    return run_both(
        scratch,
        [
            *((name, [path], {}) for name, path in programs.items()),
            ("is not there", [str(spec.workdir / "nothing")], {}),
            ("may not", [str(no_rights)], {}),
            ("nowhere", [programs["plain"]], {"cwd": "no/such/folder"}),
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
    for outcomes in (started, forked):
        outcomes["destroyed"] = in_any_order(outcomes["destroyed"][1:2])
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
    """Return a launch's output, its programs, the number killed, its status after Ctrl-C, and leftover processes."""
    prefix = scratch / "ws" / "install" / "pkg"
    for folder in ("share/ament_index/resource_index/packages", "share/pkg/launch", "lib/pkg"):
        (prefix / folder).mkdir(parents=True)
    (prefix / "share/ament_index/resource_index/packages/pkg").touch()
    (prefix / "share/pkg/launch/both.launch.py").write_text(LAUNCH_FILE)
    program(prefix / "lib/pkg", "waits", LAUNCHED)
    workspace = Workspace(scratch / "ws", environment.find(), scratch / "home")
    workspace.scratch.mkdir()
    with LaunchHarness(workspace, "pkg", "both.launch.py") as harness:
        harness.wait_for(lambda: harness.output.count("forked") == 2 and "shell" in harness.output, TIMEOUT)
        program_names = [[member.package, member.name] for member in harness.programs()]
        killed = harness.kill("waits", signal.SIGKILL)
        harness.wait_for(lambda: harness.output.count("died") == 2, TIMEOUT)
        stop = harness.interrupt(TIMEOUT)
        return [harness.output, program_names, killed, stop.status, list(stop.left)]


def test_programs_of_a_launch_are_forked_and_listed_by_name() -> None:
    output, program_names, killed, status, leftovers = in_worker_sandbox(launched)
    assert output.count("forked False ['--ros-args']") == 2, output
    assert program_names == [["pkg", "waits"]] * 2
    assert killed == 2
    assert output.count("exit code -9") == 2
    assert (status, leftovers) == (0, [])
