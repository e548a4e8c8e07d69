"""colcon with forked children builds what colcon builds, and a setup.py sees and says the same in both."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from autograder import layout
from autograder.building.build import build as build_for_grading
from autograder.building.colcon import HOST
from autograder.harness import Workspace
from autograder.probes import colcon_test
from autograder.ros import environment
from tests.e2e.cell_support import in_cell

PLAIN = Path(sys.executable).with_name("colcon")
SPIES = """
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
    'purelib': sysconfig.get_paths()['purelib'], 'warned': warnings.filters[0][0],
}
with open(Path.home() / 'seen', 'a') as log:
    print(json.dumps(seen), file=log)
atexit.register(lambda: open(Path.home() / 'ended', 'a').write('ended\\n'))
if 'install' in sys.argv:
    print('a word to stdout')
    print('a word to stderr', file=sys.stderr)
"""
AT_INSTALL = "if 'install' in sys.argv:"
FROM_RUN_TO_RUN = re.compile(r"\[[0-9.]+m?s[^]]*\]|<<<|>>>|0x[0-9a-f]+")


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    (tmp_path / "home").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "home")


def bring(workspace: Workspace, package: str, *lines: str) -> None:
    """Put a reference package there, and lines at the beginning of its setup.py."""
    folder = workspace.root / "src" / package
    shutil.copytree(layout.SOLUTIONS / package, folder, ignore=layout.NOT_COPIED)
    setup = folder / "setup.py"
    setup.write_text("\n".join([*lines, setup.read_text()]))


def build(workspace: Workspace, colcon: Path) -> subprocess.CompletedProcess[str]:
    """Build with one of the two; the spaces are left."""
    for space in ("build", "install"):
        shutil.rmtree(workspace.root / space, ignore_errors=True)
    for left in workspace.scratch.iterdir():
        shutil.rmtree(left) if left.is_dir() else left.unlink()
    command = [sys.executable, str(colcon), "--log-base", str(workspace.scratch / "log"), "build"]
    command += ["--executor", "sequential", "--event-handlers", "console_cohesion+", "desktop_notification-"]
    return subprocess.run(
        command,
        cwd=workspace.root,
        env=workspace.environment(),
        text=True,
        stdin=subprocess.DEVNULL,
        capture_output=True,
    )


def told(process: subprocess.CompletedProcess[str]) -> set[str]:
    """What a build says of packages and errors; colcon mixes its children's streams in any order.

    Its own threads share stderr, too: what one logs may come before another's end of line.
    """
    text = FROM_RUN_TO_RUN.sub("", f"{process.stdout}\n{process.stderr}").replace(" ERROR:", "\nERROR:")
    return {line.strip() for line in text.splitlines() if re.search(r"speed_guard|setup\.py|[Ee]rror|status", line)}


def files(folder: Path) -> dict[str, tuple[int, bytes]]:
    """Return mode and content of each file."""
    return {
        str(path.relative_to(folder)): (path.stat().st_mode, path.read_bytes())
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_reference_packages_are_installed_alike(workspace: Workspace) -> None:
    for package in ("my_robot_package", "my_robot_bringup", "speed_guard"):
        bring(workspace, package)
    plain = build(workspace, PLAIN)
    installed = files(workspace.install)
    hosted = build(workspace, HOST)
    assert (plain.returncode, hosted.returncode) == (0, 0), hosted.stderr
    assert len(installed) > 100
    assert files(workspace.install) == installed
    assert told(hosted) ^ told(plain) == set()


def test_a_setup_py_sees_the_same(workspace: Workspace) -> None:
    bring(workspace, "speed_guard", SPIES)
    (workspace.root / "src/speed_guard/sitecustomize.py").write_text("raise SystemExit(3)\n")

    def seen(colcon: Path) -> list[dict[str, Any]]:
        built = build(workspace, colcon)
        assert built.returncode == 0, built.stderr
        assert "a word to stderr" in built.stdout + built.stderr
        runs = [json.loads(line) for line in (workspace.scratch / "seen").read_text().splitlines()]
        assert (workspace.scratch / "ended").read_text() == "ended\n" * len(runs)
        for run in runs:
            run["path"] = [path for path in run["path"] if Path(path).name != "_vendor"]  # setuptools adds it
            # The wheels' hook writes these folders in any order.
            run["environment"]["LD_LIBRARY_PATH"] = sorted(run["environment"]["LD_LIBRARY_PATH"].split(":"))
        return runs

    plain, hosted = seen(PLAIN), seen(HOST)
    assert len(plain) == 3
    assert hosted == plain


@pytest.mark.parametrize(
    "line",
    [
        "import no_such_module",
        "this is no Python",
        f"{AT_INSTALL} raise RuntimeError('no such thing')",
        f"{AT_INSTALL} sys.exit(3)",
        f"{AT_INSTALL} exit('so it ends')",
        f"{AT_INSTALL} os._exit(7)",
        f"{AT_INSTALL} os.kill(os.getpid(), 9)",
        f"{AT_INSTALL} print(colcon_core)",
    ],
)
def test_a_setup_py_that_fails_is_told_alike(workspace: Workspace, line: str) -> None:
    bring(workspace, "speed_guard", "import os, sys", line)
    plain, hosted = build(workspace, PLAIN), build(workspace, HOST)
    assert plain.returncode != 0
    assert hosted.returncode == plain.returncode
    assert told(hosted) ^ told(plain) == set()


ODD_TESTS = """
import json, os, sys, warnings
from pathlib import Path
import pytest

def test_where(request):
    assert __name__ == "test_odd"
    seen = [sys.argv, sys.path, os.getcwd(), sys.orig_argv[:3], sys.executable, sorted(os.environ)]
    plugins = sorted({type(p).__name__ if not hasattr(p, "__name__") else p.__name__
                      for p in request.config.pluginmanager.get_plugins()})
    Path("seen").write_text(json.dumps([seen, plugins, os.getppid() > 1]))

def test_fails():
    left = {"speed": 0.3}
    assert left == {"speed": 0.4}, "too slow"

def test_warns():
    warnings.warn("look at this")

@pytest.fixture
def broken():
    yield
    raise RuntimeError("not cleaned up")

def test_broken(broken):
    os.write(1, b"said by the descriptor")

@pytest.mark.skip(reason="not today")
def test_skipped():
    pass
"""
STRICT = "[pytest]\nfilterwarnings =\n    error::pytest.PytestAssertRewriteWarning\njunit_family = xunit2\n"


def run_of(scratch: Path) -> list[Any]:
    """Return what `colcon test` makes of a package whose pytest is started, and forked."""
    workspace = Workspace(scratch / "ws", environment.find(), scratch / "home")
    workspace.scratch.mkdir()
    bring(workspace, "speed_guard")
    folder = workspace.root / "src/speed_guard"
    (folder / "test/test_odd.py").write_text(ODD_TESTS)
    (folder / "pytest.ini").write_text(STRICT)
    build_for_grading(workspace, ("speed_guard",))
    found = []
    preload = colcon_test.PRELOAD
    for way in (None, preload):
        colcon_test.PRELOAD = way  # type: ignore[assignment]
        report = colcon_test.colcon_test(workspace, "speed_guard")
        said = (line for line in report.output.splitlines() if re.search("passed|failed|[Ww]arn|[Ee]rror", line))
        verdicts = {name: verdict.value for name, verdict in report.claims.verdicts.items()}
        lines = [re.sub("=+|[0-9.]+s", "", FROM_RUN_TO_RUN.sub("", line)) for line in said]
        seen = json.loads((folder / "seen").read_text())
        found.append([report.status, verdicts, dict(report.claims.messages), sorted(lines), seen])
    return found


@pytest.mark.usefixtures("forks")
def test_colcon_test_says_the_same_of_a_pytest_that_is_forked() -> None:
    started, forked = in_cell(run_of)
    assert started[1]["test_launch::test_the_launched_guard_has_its_name_and_configuration"] == "passed", started
    assert {"passed", "failed", "error", "skipped"} == set(started[1].values())
    assert forked == started
