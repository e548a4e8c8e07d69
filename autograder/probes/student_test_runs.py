"""Runs a student's tests against versions of the package under test, and reports the results of each version.

    source = read_source(workspace, "wheels")
    reports = run(workspace, source, [TestRun(("test_limits.py",), right), TestRun(("test_limits.py",), faulty)])

The student's tests control a run: it claims "passes" or "fails", and earns points if the claim is correct for each
version. So a run must not be able to recognise its version. Every run has a sandbox with a separate loopback, a random
path, the same times and environment, and no writable folder except a temporary /tmp. It can read its version, but not
the others, the suites or earlier runs. `versions` explains how versions are made indistinguishable, and the remaining
differences. The report on a version that students do not have is returned without its text (`Report.closed`). Only a
sniffed run shares the grader's loopback, which no other program uses. The run can detect that, so its version has to be
correct.
"""

from __future__ import annotations

import errno
import os
import re
import select
import sys
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import autograder.ros
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.probes.rtps_sniffer import RtpsSniffer
from autograder.probes.student_test_reports import MAX_BYTES, Claims, Report, Source, TestRun, parse_claims
from autograder.probes.versions import write_version
from autograder.ros.domains import Domain
from autograder.run.sandbox import Isolation, Limits, Mount, Process, Sandbox
from autograder.run.sandbox.launcher import current_isolation, launch
from autograder.run.sandbox.limits import TEST_RUN
from autograder.run.workspace import Workspace
from autograder.submission.intake import read_packages
from autograder.submission.reading import reading, record_data

RUNNER = Path(__file__).with_name("pytest_runner.py")
STANDINS = Path(autograder.ros.__file__).parent / "standins"
JOBS = 5  # runs at a time; a run mostly waits for processes to start and for time to pass
HOME = Path("/tmp")  # the home folder in the sandbox


def read_source(workspace: Workspace, package: str) -> Source:
    """Read a package's source, to which the student's code could write during the build.

    Raises:
        StudentError: the source does not consist of plain files, or no folder has the package's name.
    """
    entries = read_packages(workspace.root)
    folder = next(
        (e.path.parent for e in entries if e.path.name == "package.xml" and e.path.parent.name == package), None
    )
    if folder is None:
        sentence = f"There is no folder src/{package} with a package.xml: name the folder after the package."
        raise StudentError(Diagnosis(Kind.MISSING_PACKAGE, sentence))
    package_entries = [entry for entry in entries if entry.path.is_relative_to(folder)]
    return Source(package, {entry.path.relative_to(folder).as_posix(): entry.data for entry in package_entries})


def run(workspace: Workspace, source: Source, test_runs: Sequence[TestRun]) -> list[Report]:
    """Run a package's tests in a built workspace; return a report for each run, in the given order.

    If only one run of some files had to be stopped, it is repeated, and the second run counts. The reason may be an
    executor that spins in a thread and misses its end, because `Executor.shutdown` destroys the guard condition with
    which it has just woken the executor.

    Raises:
        StudentError: the disk is full.
        GraderError: all domains for sniffed runs are in use.
    """
    record_data("The report of your tests")
    with ThreadPoolExecutor(JOBS) as pool:
        run_once = partial(_run, workspace, source)
        reports = list(pool.map(run_once, test_runs))
        stopped_indices = [index for index, report in enumerate(reports) if report.timed_out]
        files = Counter(test_runs[index].files for index in stopped_indices)
        retries = [index for index in stopped_indices if files[test_runs[index].files] == 1]
        for index, report in zip(retries, pool.map(run_once, [test_runs[i] for i in retries]), strict=True):
            reports[index] = report
    return reports


def sandboxed(workspace: Workspace, *readable: Path, limits: Limits = TEST_RUN, network: bool = False) -> Sandbox:
    """Return the sandbox of a run: that of the workspace, with the files that pytest needs.

    Args:
        workspace: the built workspace.
        readable: additional files and folders that the run may read.
        limits: the resource limits of the run.
        network: whether the run shares the grader's loopback.
    """
    mounts = (*workspace.sandbox().mounts, Mount(STANDINS), *map(Mount, readable))
    spec = workspace.sandbox(limits)
    environment = {**spec.environment, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    return replace(spec, mounts=mounts, environment=environment, network=network)


def _run(workspace: Workspace, source: Source, test_run: TestRun) -> Report:
    try:
        with TemporaryDirectory(prefix="tests-", dir=workspace.root.parent, ignore_cleanup_errors=True) as run_folder:
            if current_isolation() is Isolation.BUBBLEWRAP:
                return _run_in(Path(run_folder), workspace, source, test_run)
            with Domain() as domain:  # at this isolation level, all runs share one network
                return _run_in(Path(run_folder), replace(workspace, domain=domain.number), source, test_run)
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            with reading(f"The package {source.package}", advice="A folder has the name of a file, or vice versa."):
                raise
        sentence = "The disk is full, so your tests could not run: make the files of the package or its build smaller."
        raise StudentError(Diagnosis(Kind.OUT_OF_MEMORY, sentence)) from None


def _run_in(run_folder: Path, workspace: Workspace, source: Source, test_run: TestRun) -> Report:
    if test_run.version is not None:
        tested_workspace = replace(workspace, root=run_folder / "ws")
        folder = write_version(test_run.version, source.package, source.tests, tested_workspace.root)
    else:
        tested_workspace, folder = workspace, run_folder / "ws" / "src" / source.package
        for name, data in source.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(data)
    launches = _launches(source, test_run)
    arguments = _arguments(source, folder, test_run, launches)
    if not test_run.sniffed:
        report = _start_pytest(
            _sandbox_of(tested_workspace, folder, test_run, run_folder / "home"), test_run, arguments, launches
        )
    else:
        with RtpsSniffer() as sniffer:
            spec = _sandbox_of(replace(tested_workspace, domain=sniffer.domain), folder, test_run, run_folder / "home")
            report = _start_pytest(spec, test_run, arguments, launches)
            report = replace(report, joined_domain=sniffer.take_announcements())
    is_secret = test_run.version is not None and not test_run.is_public
    return report.closed(source.test_names(test_run.files)) if is_secret else report


def _sandbox_of(workspace: Workspace, folder: Path, test_run: TestRun, home: Path) -> Sandbox:
    """Return the sandbox of one run. With bubblewrap, the only writable folder is the sandbox's own /tmp."""
    if current_isolation() is Isolation.BUBBLEWRAP:
        spec = sandboxed(replace(workspace, scratch=HOME), folder, RUNNER, network=test_run.sniffed)
        return replace(spec, workdir=folder, mounts=tuple(mount for mount in spec.mounts if mount.path != HOME))
    home.mkdir(parents=True)
    return replace(sandboxed(replace(workspace, scratch=home), folder, RUNNER, network=True), workdir=folder)


def _arguments(source: Source, folder: Path, test_run: TestRun, launches: bool) -> list[str]:
    files = [str(folder / "test" / name) for name in test_run.files]
    config = ["-c", "/dev/null", "--rootdir", str(folder), "--confcutdir", str(folder)]
    config += [word for plugin in _launch_plugins() for word in ("-p", plugin)] if launches else []
    output = ["-p", "no:cacheprovider", "-q", "--tb=short", "-o", "junit_family=xunit2"]
    selection = [*(["-x"] if test_run.exit_first else []), *([] if test_run.conftest else ["--noconftest"])]
    for test in test_run.deselected:
        module, _, name = test.partition("::")
        selection.append(f"--deselect=test/{module}.py::{name}")
    return [*config, *output, *selection, *files]


def _launch_plugins() -> tuple[str, str]:
    """Return the plugins for both styles of launch tests, launch_pytest and launch_testing."""
    spec = find_spec("launch_testing")
    is_real = spec is not None and spec.origin is not None and not Path(spec.origin).is_relative_to(STANDINS)
    return "launch_pytest.plugin", "launch_testing.pytest.hooks" if is_real else "launch_testing.plugin"


def _launches(source: Source, test_run: TestRun) -> bool:
    """Return whether tests may launch programs, which requires further imports."""
    names = [*test_run.files, *(name for name in source.tests if not Path(name).name.startswith("test_"))]
    return any(b"launch" in source.tests.get(name, b"") for name in names)


def _start_pytest(spec: Sandbox, test_run: TestRun, arguments: list[str], launches: bool) -> Report:
    status_read, status_write = os.pipe()
    go_read, go_write = os.pipe()
    with os.fdopen(os.memfd_create("report"), "w+b") as report:
        descriptors = (report.fileno(), status_write, go_read)
        command = [sys.executable, str(RUNNER), *map(str, descriptors), str(int(test_run.backwards)), *arguments]
        try:
            process = launch(command, spec, pass_fds=descriptors, profile="launch" if launches else "tests")
        finally:
            os.close(status_write)
            os.close(go_read)
        with process:
            status = _status(status_read, process)
            open_sockets, is_logging = leftovers(process.innermost()) if status is not None else (0, False)
            os.close(go_write)
            process.wait(spec.limits.wall_seconds)
            exit_reason = process.exit_reason
        report.seek(0)
        claims = None if status is None else parse_claims(report.read(MAX_BYTES + 1))
    if claims is None:
        return Report(exit_reason, None, Claims(), open_sockets, process.output, is_logging)
    return Report(exit_reason, status, claims, open_sockets, process.output, is_logging)


def _status(descriptor: int, process: Process) -> int | None:
    """Wait for pytest's exit status, which the run sends after its report; return None if the run ends without it."""
    try:
        while not select.select([descriptor], [], [], 0.1)[0]:
            if process.exit_reason is not None:
                return None
        data = os.read(descriptor, 64)
        return int(data) if re.fullmatch(rb"[0-5]\n", data) else None
    finally:
        os.close(descriptor)


def leftovers(pid: int) -> tuple[int, bool]:
    """Return the number of a process's open UDP sockets, and whether it has a log file open."""
    folder = Path("/proc") / str(pid)
    try:
        targets = [str(link.readlink()) for link in (folder / "fd").iterdir()]
        rows = (folder / "net" / "udp").read_text().splitlines()[1:]
    except OSError:
        return 0, False
    inodes = {target[len("socket:[") : -1] for target in targets if target.startswith("socket:[")}
    return sum(row.split()[9] in inodes for row in rows), any(target.endswith(".log") for target in targets)
