"""A forked colcon builds the same files as a started one, and a setup.py sees and prints the same in both."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from autograder import course_paths
from autograder.building.colcon import RUNNER
from autograder.harness import Workspace
from autograder.ros import environment
from autograder.run.sandbox import Mount, Sandbox
from autograder.run.sandbox.launcher import launch
from autograder.run.sandbox.limits import BUILD
from tests.e2e.sandbox_support import in_worker_sandbox, is_forked

pytestmark = pytest.mark.usefixtures("forks")

SPY = """
import atexit, json, logging, os, signal, sys, sysconfig, warnings
from pathlib import Path

seen = {
    'argv': sys.argv, 'path': sys.path, 'executable': sys.executable, 'prefix': sys.prefix, 'name': __name__,
    'file': globals().get('__file__'), 'cwd': os.getcwd(), 'environment': dict(os.environ),
    'descriptors': sorted(name for name in os.listdir('/proc/self/fd') if os.path.exists(f'/proc/self/fd/{name}')),
    'streams': [os.path.basename(os.readlink(f'/proc/self/fd/{n}')).split(':')[0] for n in (0, 1, 2)],
    'signals': [str(signal.getsignal(n)) for n in (signal.SIGINT, signal.SIGTERM, signal.SIGCHLD)],
    'handlers': len(logging.root.handlers), 'level': logging.root.level, 'main': sorted(vars(sys.modules['__main__'])),
    'encodings': [sys.stdout.encoding, sys.stderr.encoding, sys.stderr.errors],
    'forked': 'asyncio' in sys.modules,
    'purelib': sysconfig.get_paths()['purelib'], 'warned': warnings.filters[0][0],
}
with open(Path.home() / 'seen', 'a') as log:
    print(json.dumps(seen), file=log)
atexit.register(lambda: open(Path.home() / 'ended', 'a').write('ended\\n'))
if 'install' in sys.argv:
    print('a line on stdout')
    print('a line on stderr', file=sys.stderr)
"""
AT_INSTALL = "if 'install' in sys.argv:"
DIFFERS_BETWEEN_RUNS = re.compile(r"\[-?[0-9.]+m?s[^]]*\]|<<<|>>>|0x[0-9a-f]+")


def add_package(workspace: Workspace, package: str, *lines: str) -> None:
    """Copy a reference package to the workspace, and insert lines at the beginning of its setup.py."""
    folder = workspace.root / "src" / package
    shutil.copytree(course_paths.SOLUTIONS / package, folder, ignore=course_paths.NOT_COPIED)
    setup = folder / "setup.py"
    setup.write_text("\n".join([*lines, setup.read_text()]))


def build(workspace: Workspace, profile: str | None) -> tuple[int | None, str]:
    """Build by a colcon that is started or forked; return its exit status and output. Keep what was built."""
    for folder in (workspace.root / "build", workspace.install, workspace.scratch):
        shutil.rmtree(folder, ignore_errors=True)
    workspace.scratch.mkdir()
    command = [sys.executable, str(RUNNER), "--log-base", str(workspace.scratch / "log"), "build", "--executor"]
    command += ["sequential", "--event-handlers", "console_cohesion+", "desktop_notification-"]
    mounts = (Mount(RUNNER), Mount(workspace.root, writable=True), Mount(workspace.scratch, writable=True))
    spec = Sandbox(workspace.root, mounts, environment=workspace.environment(), limits=BUILD)
    with launch(command, spec, profile=profile) as process:
        assert profile is None or is_forked(process)
        assert process.wait(BUILD.wall_seconds)
        return process.returncode, process.output


def build_both_ways(scratch: Path, packages: list[list[str]]) -> list[dict[str, Any]]:
    """Build packages, each with its lines, started and forked; return the outcome of each build."""
    workspace = Workspace(scratch / "ws", environment.find(), scratch / "home")
    for package, *lines in packages:
        add_package(workspace, package, *lines)
    (workspace.root / "src/speed_guard/sitecustomize.py").write_text("raise SystemExit(3)\n")
    outcomes = []
    for profile in (None, "colcon"):
        status, output = build(workspace, profile)
        note_files = [workspace.scratch / name for name in ("seen", "ended")]
        seen_lines, ended_lines = (file.read_text().splitlines() if file.exists() else [] for file in note_files)
        installed = digests(workspace.install)
        outcomes.append(
            {"status": status, "output": output, "seen": seen_lines, "ended": ended_lines, "installed": installed}
        )
    return outcomes


def relevant_lines(output: str) -> set[str]:
    """Return the lines about packages and errors, as a set: colcon mixes its children's streams in any order.

    Since Python 3.13, the traceback of a started program also shows the source of `python -c`.
    """
    text = DIFFERS_BETWEEN_RUNS.sub("", output)
    lines = (line.strip() for line in text.splitlines() if re.search(r"speed_guard|setup\.py|[Ee]rror|status", line))
    return {line for line in lines if not line.startswith("import sys;")}


def digests(folder: Path) -> dict[str, list[Any]]:
    """Return the mode and a digest of each file."""
    return {
        str(path.relative_to(folder)): [path.stat().st_mode, hashlib.sha256(path.read_bytes()).hexdigest()]
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_reference_packages_are_installed_alike_by_a_forked_and_a_started_colcon() -> None:
    started, forked = in_worker_sandbox(build_both_ways, [["my_robot_package"], ["my_robot_bringup"], ["speed_guard"]])
    assert (started["status"], forked["status"]) == (0, 0), forked["output"]
    assert len(started["installed"]) > 100
    assert forked["installed"] == started["installed"]
    assert relevant_lines(forked["output"]) ^ relevant_lines(started["output"]) == set()


def test_a_setup_py_sees_the_same_in_a_forked_and_a_started_colcon() -> None:
    outcomes = in_worker_sandbox(build_both_ways, [["speed_guard", SPY]])
    for outcome in outcomes:
        assert outcome["status"] == 0, outcome["output"]
        assert "a line on stderr" in outcome["output"]
        assert outcome["ended"] == ["ended"] * 3
        outcome["seen"] = [json.loads(line) for line in outcome["seen"]]
        for run in outcome["seen"]:
            run["path"] = [path for path in run["path"] if Path(path).name != "_vendor"]  # setuptools adds it
            # The wheels' hook writes these folders in any order.
            run["environment"]["LD_LIBRARY_PATH"] = sorted(run["environment"]["LD_LIBRARY_PATH"].split(":"))
    started, forked = outcomes
    assert [run.pop("forked") for run in started["seen"] + forked["seen"]] == [False] * 3 + [True] * 3
    assert forked["seen"] == started["seen"]


@pytest.mark.parametrize(
    "line",
    [
        "this is not valid Python",
        f"{AT_INSTALL} raise RuntimeError('no such thing')",
        f"{AT_INSTALL} os._exit(7)",
        *(
            pytest.param(line, marks=pytest.mark.nightly)
            for line in (
                "import no_such_module",
                f"{AT_INSTALL} sys.exit(3)",
                f"{AT_INSTALL} exit('stopped')",
                f"{AT_INSTALL} os.kill(os.getpid(), 9)",
                f"{AT_INSTALL} print(colcon_core)",
            )
        ),
    ],
)
def test_a_failing_setup_py_is_reported_alike_by_a_forked_and_a_started_colcon(line: str) -> None:
    started, forked = in_worker_sandbox(build_both_ways, [["speed_guard", "import os, sys", line]])
    assert started["status"] != 0
    assert forked["status"] == started["status"]
    assert relevant_lines(forked["output"]) ^ relevant_lines(started["output"]) == set()
