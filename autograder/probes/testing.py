"""Runs a student's tests against versions of the package under test: what do they say of each?

    reports = run(workspace, "speed_guard", [Order(("test_limits.py",), right), Order(("test_limits.py",), faulty)])

Tests are programs of the student's. A run is in their power: what it reports is taken for a claim, "passes" or
"fails", and the points come from claiming the right thing of each version. So a run must not be able to tell which
version it has before it: every run gets a sandbox of its own with a fresh home, no network but its own loopback, the
same paths, times and environment, and sees its version and nothing of the others, the suites or earlier runs. See
`versions` for how versions are kept alike. What remains is written there, too.
"""

from __future__ import annotations

import os
import queue
import selectors
import shutil
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path

import autograder.ros
from autograder.exceptions import GraderError
from autograder.lab.workspace import Workspace
from autograder.probes import junit
from autograder.probes.junit import Claims, Verdict
from autograder.probes.versions import Version, lay_down
from autograder.sandbox import Ending, Limits, Mount, Process, Sandbox
from autograder.sandbox.launcher import launch

HOST = Path(__file__).with_name("pytest_host.py")
INTRUDER = Path(__file__).with_name("intruder.py")
STANDINS = Path(autograder.ros.__file__).parent / "standins"
LIMITS = Limits(wall_seconds=60.0, cpu_seconds=40, threads=768)
LANES = 5  # runs at a time: most of a run is waiting, for processes to start and for time to pass
DISTURBED_DOMAIN = 97  # where a test meets the intruder, unless it has a domain of its own
READY_SECONDS = 30.0
REPORT = "report.xml"


@dataclass(frozen=True)
class Order:
    """One run of a student's tests.

    Attributes:
        files: test files, by their paths below the package's folder `test`.
        version: the package under test; None for the student's own, as it was built.
        backwards: whether the tests run in the opposite order.
        first_failure: whether the run ends with the first test that fails.
        intruder: topics, with their types, on which another robot publishes in the default domain.
    """

    files: tuple[str, ...]
    version: Version | None = None
    backwards: bool = False
    first_failure: bool = False
    intruder: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Report:
    """What became of a run; all of it but `ending` and `left` is the run's own claim.

    Attributes:
        ending: how its process ended; None when the grader ended it after pytest was done.
        status: pytest's exit status, None when it never came to that.
        claims: what it says of its tests.
        left: UDP sockets that were still open after the last test: each ROS context that is not ended holds some.
        output: what it printed.
    """

    ending: Ending | None
    status: int | None
    claims: Claims
    left: int
    output: str

    @property
    def passed(self) -> bool:
        """Whether tests ran and each one passed."""
        return self.status == 0 and bool(self.executed) and not self.failed

    @property
    def executed(self) -> tuple[str, ...]:
        """The tests that ran and were not skipped."""
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict is not Verdict.SKIPPED)

    @property
    def failed(self) -> tuple[str, ...]:
        """The tests that failed, in themselves or in a fixture."""
        bad = (Verdict.FAILED, Verdict.ERROR)
        return tuple(name for name, verdict in self.claims.verdicts.items() if verdict in bad)

    def objects(self, right: Report) -> bool:
        """Whether a test fails here that passed on a right version. A file that cannot be read does not count."""
        return self.status == 1 and bool(set(self.failed) & set(right.executed) - set(right.failed))


def run(workspace: Workspace, package: str, orders: Sequence[Order], lanes: int = LANES) -> list[Report]:
    """Carry the orders out, some at a time; return a report for each, in their order.

    The tests are those in `test` of the student's package, whichever version they run against.

    Raises:
        GraderError: an intruder did not start.
    """
    free: queue.SimpleQueue[int] = queue.SimpleQueue()
    for lane in range(lanes):
        free.put(lane)

    def carry_out(order: Order) -> Report:
        lane = free.get()
        try:
            return _run(workspace, package, order, lane)
        finally:
            free.put(lane)

    with ThreadPoolExecutor(lanes) as pool:
        return list(pool.map(carry_out, orders))


def sandboxed(workspace: Workspace, *readable: Path, limits: Limits = LIMITS, network: bool = False) -> Sandbox:
    """Describe the sandbox of a run: the workspace's, and what pytest needs beside it."""
    mounts = (*workspace.sandbox().mounts, Mount(STANDINS), *map(Mount, readable))
    plain = workspace.sandbox(limits)
    environment = {**plain.environment, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    return replace(plain, mounts=mounts, environment=environment, network=network)


def _run(workspace: Workspace, package: str, order: Order, lane: int) -> Report:
    place = workspace.root.with_name(f"{workspace.root.name}-tests") / f"lane{lane}"
    shutil.rmtree(place, ignore_errors=True)
    (place / "home").mkdir(parents=True)
    domain = DISTURBED_DOMAIN if order.intruder else (workspace.domain + 1 + lane) % 100
    there = replace(workspace, scratch=place / "home", domain=domain)
    tests = source_of(workspace, package) / "test"
    if order.version is None:
        folder = tests.parent
    else:
        there = replace(there, root=place / "ws")
        folder = lay_down(order.version, package, tests, there.root)
    spec = replace(sandboxed(there, folder, HOST, network=bool(order.intruder)), workdir=folder)
    with _disturbed(there, order.intruder) if order.intruder else nullcontext():
        return _host(spec, place / "home" / REPORT, _arguments(folder, place / "home" / REPORT, order), order.backwards)


def source_of(workspace: Workspace, package: str) -> Path:
    """Return the folder of a package's source.

    Raises:
        GraderError: there is none, though it was built.
    """
    for manifest in sorted((workspace.root / "src").rglob("package.xml")):
        if manifest.parent.name == package:
            return manifest.parent
    raise GraderError(f"{package} was built, but has no folder of its name below src")


def _arguments(folder: Path, report: Path, order: Order) -> list[str]:
    files = [str(folder / "test" / name) for name in order.files]
    plain = ["-c", "/dev/null", "--rootdir", str(folder), "--confcutdir", str(folder), "-p", "launch_pytest.plugin"]
    quiet = ["-p", "no:cacheprovider", "-q", "--tb=short", "-o", "junit_family=xunit2", f"--junitxml={report}"]
    return [*plain, *quiet, *(["-x"] if order.first_failure else []), *files]


def _host(spec: Sandbox, report: Path, arguments: list[str], backwards: bool) -> Report:
    ended_read, ended_write = os.pipe()
    go_read, go_write = os.pipe()
    command = [sys.executable, str(HOST), str(ended_write), str(go_read), str(int(backwards)), *arguments]
    try:
        process = launch(command, spec, pass_fds=(ended_write, go_read))
    finally:
        os.close(ended_write)
        os.close(go_read)
    with process:
        status = _status(ended_read, process)
        left = open_sockets(process.innermost()) if status is not None else 0
        os.close(go_write)
        process.wait(spec.limits.wall_seconds)
        ending = process.ending
    claims = junit.read(report) if status is not None else None
    if claims is None:
        return Report(ending, None, Claims(), left, process.output)
    return Report(ending, status, claims, left, process.output)


def _status(descriptor: int, process: Process) -> int | None:
    """Return pytest's exit status as the run says it, or None when the process ends without a word."""
    try:
        with selectors.DefaultSelector() as selector:
            selector.register(descriptor, selectors.EVENT_READ)
            while not selector.select(0.1):
                if process.ending is not None:
                    return None
        word = os.read(descriptor, 16).strip()
        return int(word) if word.isdigit() else None
    finally:
        os.close(descriptor)


def open_sockets(pid: int) -> int:
    """Count the UDP sockets that a process holds."""
    inodes = set()
    try:
        for link in (Path("/proc") / str(pid) / "fd").iterdir():
            target = str(link.readlink())
            if target.startswith("socket:["):
                inodes.add(target[len("socket:[") : -1])
        rows = (Path("/proc") / str(pid) / "net" / "udp").read_text().splitlines()[1:]
    except OSError:
        return 0
    return sum(row.split()[9] in inodes for row in rows)


@contextmanager
def _disturbed(workspace: Workspace, topics: Mapping[str, str]) -> Iterator[None]:
    spec = sandboxed(workspace, INTRUDER, network=True)
    words = [f"{topic}={kind}" for topic, kind in topics.items()]
    with launch([sys.executable, str(INTRUDER), *words], spec) as process:
        deadline = time.monotonic() + READY_SECONDS
        while "ready" not in process.output and time.monotonic() < deadline and not process.wait(0.05):
            pass
        if "ready" not in process.output:
            raise GraderError(f"the other robot did not start: {process.output[-500:]}")
        yield
