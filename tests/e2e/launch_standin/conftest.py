"""A package with nodes and launch files, and `ros2 launch` as a process whose output can be waited for.

Each launch has a separate network, so that nodes of parallel tests do not discover each other. All
processes of a launch inherit a mark in their environment, which identifies processes that are left over.

With the real launch installed, the tests run it, except the tests in differences.yaml.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path

import launch as launch_package
import pytest
import yaml

from autograder.ros import environment
from tests.e2e.launch_cases.runner import is_idle

HERE = Path(__file__).parent
PATIENCE = 120.0  # seconds: generous, because it matters only if something is wrong
MARK = "COURSE_LAUNCH_MARK"
OWN_NETWORK = ("unshare", "-rn", "sh", "-c", 'ip link set lo up && exec "$@"', "sh")
DIFFERENCES: dict[str, str] = yaml.safe_load((HERE / "differences.yaml").read_text())
STAND_IN = "standins" in str(launch_package.__file__)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """With the real launch, skip the tests of known differences, and allow open log files and sockets."""
    for item in items:
        if STAND_IN or item.path.parent != HERE:
            continue
        item.add_marker(pytest.mark.filterwarnings("ignore::ResourceWarning"))
        if reason := next((DIFFERENCES[name] for name in DIFFERENCES if item.name.startswith(name)), ""):
            item.add_marker(pytest.mark.skip(reason=f"the real launch differs: {reason}"))


class Launch:
    """A running `ros2 launch`."""

    def __init__(self, command: list[str], variables: dict[str, str]) -> None:
        self._mark = uuid.uuid4().hex
        self._process = subprocess.Popen(
            command,
            env={**os.environ, **variables, MARK: self._mark},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.text = ""
        self._changed = threading.Condition()
        self._ended = False
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as stream:
            for line in stream:
                with self._changed:
                    self.text += line
                    self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def wait_for(self, pattern: str) -> re.Match[str]:
        """Wait until the output matches `pattern`; fail if it ends without it."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended or re.search(pattern, self.text), timeout=PATIENCE)
            match = re.search(pattern, self.text)
        assert match, f"{pattern!r} is not in the output:\n{self.text}"
        return match

    def send(self, number: signal.Signals) -> None:
        """Send a signal to the launch process alone."""
        self._process.send_signal(number)

    def finish(self) -> int:
        """Wait for the end; return the exit code."""
        code = self._process.wait(timeout=PATIENCE)
        self._reader.join(timeout=PATIENCE)
        return code

    def interrupt(self) -> int:
        """Send SIGINT as soon as the launch is idle, and wait for its end; return the exit code."""
        deadline = time.monotonic() + PATIENCE
        while not is_idle(self._process.pid):
            assert time.monotonic() < deadline, f"the launch does not become idle:\n{self.text}"
            time.sleep(0.01)
        self.send(signal.SIGINT)
        return self.finish()

    def members(self) -> dict[int, str]:
        """Return the command lines of all living processes of this launch, by process id."""
        commands = {}
        for folder in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                if f"{MARK}={self._mark}".encode() in (folder / "environ").read_bytes():
                    commands[int(folder.name)] = (folder / "cmdline").read_text().replace("\0", " ")
        return commands

    def clean_up(self) -> None:
        """Kill the remaining processes."""
        for pid in self.members():
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        self.finish()


@pytest.fixture
def own_log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Give launches in the test's process a separate log folder and event loop.

    The real launch uses the current loop of the thread.
    """
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    launch_package.logging.reset()
    yield
    launch_package.logging.reset()
    asyncio.set_event_loop(None)
    loop.close()
    if not STAND_IN:
        gc.collect()  # reports the sockets that it left open here, where such warnings are ignored


def _install_fleet(prefix: Path) -> None:
    """Install the package `fleet`, as colcon would, into `prefix`."""
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "fleet").touch()
    for folder in ("launch", "config"):
        shutil.copytree(HERE / "fleet" / folder, prefix / "share/fleet" / folder)
    executables = prefix / "lib/fleet"
    executables.mkdir(parents=True)
    for source in (HERE / "fleet/lib").iterdir():
        (executables / source.name).write_text(f"#!{sys.executable}\n{source.read_text()}")
        (executables / source.name).chmod(0o755)


@pytest.fixture(scope="session")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The prefix in which the package `fleet` is installed."""
    prefix = tmp_path_factory.mktemp("fleet") / "install"
    _install_fleet(prefix)
    return prefix


@pytest.fixture(scope="session")
def install_fleet() -> Callable[[Path], None]:
    """Return a function that installs the package `fleet` into a prefix."""
    return _install_fleet


Start = Callable[..., Launch]


@pytest.fixture
def start(fleet: Path, tmp_path: Path) -> Iterator[Start]:
    """Return a function that starts `ros2 launch fleet FILE ARGUMENT...`, with a sourced workspace if one is given.

    None of the processes may be left at the end of the test.
    """
    running: list[Launch] = []

    def start_launch(file: str, *arguments: str, install: Path | None = None) -> Launch:
        variables = environment.find().variables(overlays=(fleet,), log_dir=tmp_path / "log")
        ros2 = [sys.executable, "-m", "autograder.ros.ros2", "launch"]
        sourced = [] if install is None else ["bash", "-c", 'source "$0/setup.bash" && exec "$@"', str(install)]
        launch = Launch([*OWN_NETWORK, *sourced, *ros2, "fleet", f"{file}.launch.py", *arguments], variables)
        running.append(launch)
        return launch

    yield start_launch
    leftovers = [launch.members() for launch in running]
    for launch in running:
        launch.clean_up()
    assert not any(leftovers), f"processes are left over: {leftovers}"
