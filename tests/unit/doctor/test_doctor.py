"""Each finding is reported on a machine that lacks the thing, with the command that fixes it."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from autograder.course_paths import ROOT
from autograder.doctor import CommandResult, Finding, Status, System, examine, healthy, render
from autograder.ros import RosEnvironment, RosNotFoundError, WrongDistroError
from autograder.ros.distribution import DISTRIBUTION
from autograder.run.sandbox.isolation import namespaces_failure

VENV = Path("/course/.venv")
WHEELS = RosEnvironment("wheels", (VENV,), VENV / "lib/python3.12/site-packages/rclpy")
SOURCED = RosEnvironment("sourced", (Path("/opt/ros/sourced"),), Path("/opt/ros/sourced/lib/rclpy"))
FILES = {
    VENV / "share/rclpy/package.xml": f"<package><version>{DISTRIBUTION.rclpy}.6</version></package>",
    Path("/opt/ros/sourced/share/rclpy/package.xml"): f"<package><version>{DISTRIBUTION.rclpy}.4</version></package>",
    Path("/usr/include/python3.12/Python.h"): "",
}
VERSIONS: dict[str, str] = {package.name: package.version for package in DISTRIBUTION.packages}
DENIED = "bwrap: setting up uid map: Permission denied"


def fake_run(failing: Mapping[str, CommandResult]) -> Callable[[Sequence[str], Mapping[str, str]], CommandResult]:
    """Return a `run` in which all commands succeed, except those that contain one of the given words."""

    def run(command: Sequence[str], _: Mapping[str, str]) -> CommandResult:
        fine = CommandResult(0, f"{command[0]} 1.0")
        return next((result for words, result in failing.items() if words in " ".join(command)), fine)

    return run


def complete_machine(**replaced: Any) -> System:
    """Return a machine that lacks nothing, with some attributes replaced."""
    system = System()
    vars(system).update({**COMPLETE, **replaced})
    return system


COMPLETE: dict[str, Any] = dict(
    python=(3, 12, 1),
    platform=("Linux", "x86_64"),
    prefix=VENV,
    in_venv=True,
    headers=Path("/usr/include/python3.12"),
    environ={},
    tmp=Path("/tmp"),
    which=lambda command: f"/usr/bin/{command}",
    run=fake_run({}),
    read=FILES.get,
    disk_usage=lambda path: SimpleNamespace(free=50 * 1024**3),
    writable=lambda path: True,
    package=lambda name: VERSIONS.get(name, "1.2"),
    find_ros=lambda: WHEELS,
    describe_launch=lambda: "launch 3.4.3, launch_ros 0.26.6, ros2cli 0.32.2",
    unpatched_cmake_files=lambda prefix: [],
    namespaces_failure=lambda: None,
    bounds=lambda: frozenset({"pids", "memory"}),
    closed_to_other_users=lambda: None,
)


def without(*commands: str) -> Callable[[str], str | None]:
    """Return a `which` that does not find the given commands."""
    return lambda command: None if command in commands else f"/usr/bin/{command}"


def raising(error: Exception) -> Callable[[], RosEnvironment]:
    """Return a `find_ros` that raises."""

    def find() -> RosEnvironment:
        raise error

    return find


def finding(name: str, **replaced: Any) -> Finding:
    """Examine the complete machine with some attributes replaced, and return the finding of that name."""
    return next(reported for reported in examine(complete_machine(**replaced)) if reported.name == name)


def test_a_complete_machine_is_healthy_and_has_nothing_to_fix() -> None:
    findings = examine(complete_machine())
    assert {reported.status for reported in findings} == {Status.OK}, findings
    assert [reported.fix for reported in findings if reported.fix] == []
    assert healthy(findings)


@pytest.mark.promise("`autograder doctor` and the field `launch` of each result say what is installed.")
@pytest.mark.parametrize(
    ("installed", "description"),
    [
        ("launch 3.4.3, launch_ros 0.26.6, ros2cli 0.32.2", "launch 3.4.3, launch_ros 0.26.6, ros2cli 0.32.2"),
        ("stand-ins", "the course's stand-ins; `make real-launch` installs the real ones if GitHub is reachable"),
    ],
)
def test_the_doctor_says_which_launch_is_installed_and_both_are_fine(installed: str, description: str) -> None:
    reported = finding("launch, ros2", describe_launch=lambda: installed)
    assert (reported.status, reported.state) == (Status.OK, description)


def test_the_nearest_version_for_this_python_needs_no_fix() -> None:
    reported = finding("versions", package={**VERSIONS, "numpy": "2.1.3"}.get)
    assert reported.status is Status.OK
    assert reported.state == "as on Ubuntu 24.04, except numpy 2.1.3 for 1.26.4: the nearest for this Python"


def sysctl(name: str, value: str) -> Callable[[Path], str | None]:
    """Return a `read` that knows one kernel setting besides the usual files."""
    return {**FILES, Path("/proc/sys") / name.replace(".", "/"): f"{value}\n"}.get


def unwritable(folder: str) -> Callable[[Path], bool]:
    """Return a `writable` that denies one folder."""
    return lambda path: path != Path(folder)


LACKS: dict[str, tuple[str, dict[str, Any], Status, str, str]] = {
    "an old Python": ("Python", {"python": (3, 9, 18)}, Status.MISSING, "3.9.18", "make setup PYTHON=python3.12"),
    "a Python without wheels": ("Python", {"python": (3, 14, 0)}, Status.MISSING, "3.10 to 3.13", "PYTHON=python3.12"),
    "a Mac": ("Python", {"platform": ("Darwin", "arm64")}, Status.MISSING, "Darwin arm64", "devcontainer up"),
    "an ARM board": ("Python", {"platform": ("Linux", "aarch64")}, Status.MISSING, "a JupyterHub", "devcontainer up"),
    "the system's own Python": ("environment", {"in_venv": False}, Status.WEAK, "not a virtual", "make setup"),
    "a Python that root alone can run": (
        "other users",
        {"closed_to_other_users": lambda: "other users cannot run .venv, because they cannot enter /root"},
        Status.WEAK,
        "cannot enter /root",
        "make setup PYTHON=/usr/bin/python3",
    ),
    "no ROS": (
        "ROS 2",
        {"find_ros": raising(RosNotFoundError("rclpy cannot be imported"))},
        Status.MISSING,
        "rclpy cannot be imported",
        "make setup",
    ),
    "another distribution": (
        "ROS 2",
        {"find_ros": raising(WrongDistroError("the sourced ROS 2 is humble"))},
        Status.MISSING,
        "humble",
        "env -i HOME",
    ),
    "wheels and a sourced ROS at once": (
        "ROS 2",
        {"find_ros": lambda: SOURCED},
        Status.WEAK,
        f"rclpy {DISTRIBUTION.rclpy}.4; the wheels are also installed",
        "make setup",
    ),
    "the wheels of a later ROS": (
        "ROS 2",
        {"read": {VENV / "share/rclpy/package.xml": "<version>9.2.0</version>"}.get},
        Status.MISSING,
        f"rclpy 9.2.0 in /course/.venv is not {DISTRIBUTION.title}'s",
        "make setup",
    ),
    "half an installation": ("ROS 2", {"read": {}.get}, Status.MISSING, "no package.xml", "make setup"),
    "CMake files not patched": (
        "CMake files",
        {"unpatched_cmake_files": lambda prefix: 15 * [prefix]},
        Status.MISSING,
        "15 CMake files",
        "-m autograder.ros.patch_wheels",
    ),
    "a chosen log folder that is not writable": (
        "ROS logs",
        {"environ": {"ROS_LOG_DIR": "/closed"}, "writable": unwritable("/closed")},
        Status.MISSING,
        "/closed, is not writable",
        "unset ROS_LOG_DIR",
    ),
    "a default log folder that is not writable": (
        "ROS logs",
        {"writable": lambda path: False},
        Status.MISSING,
        "is not writable",
        "export ROS_LOG_DIR=~/.ros/log",
    ),
    "an rclpy that does not start": (
        "rclpy",
        {
            "run": fake_run(
                {"import rclpy": CommandResult(1, "Traceback\n  File\nImportError: librcl.so: no such file\n\n")}
            )
        },
        Status.MISSING,
        "a node does not start: ImportError: librcl.so: no such file",
        "make setup",
    ),
    "a sourced rclpy that does not start": (
        "rclpy",
        {"find_ros": lambda: SOURCED, "run": fake_run({"import rclpy": CommandResult(-11, "")})},
        Status.MISSING,
        "exit status -11",
        f"source {DISTRIBUTION.setup}",
    ),
    "nodes kept to this host": (
        "ROS variables",
        {"environ": {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_LOCALHOST_ONLY": "0"}},
        Status.WEAK,
        "ROS_AUTOMATIC_DISCOVERY_RANGE prevents discovery",
        "unset ROS_AUTOMATIC_DISCOVERY_RANGE",
    ),
    "another middleware": (
        "ROS variables",
        {"environ": {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp", "ROS_DISCOVERY_SERVER": "10.0.0.1"}},
        Status.MISSING,
        "selects rmw_cyclonedds_cpp",
        "unset ROS_DISCOVERY_SERVER RMW_IMPLEMENTATION",
    ),
    "a domain out of range": (
        "ROS variables",
        {"environ": {"ROS_DOMAIN_ID": "300"}},
        Status.MISSING,
        "is 300, but must be 0 to 232",
        "unset ROS_DOMAIN_ID",
    ),
    "a domain that is not a number": (
        "ROS variables",
        {"environ": {"ROS_DOMAIN_ID": "lab"}},
        Status.MISSING,
        "is lab, but must be",
        "unset ROS_DOMAIN_ID",
    ),
    "no C++ compiler": (
        "compiler",
        {"run": fake_run({"g++": CommandResult(127, "")})},
        Status.MISSING,
        "g++ not found",
        "sudo apt-get install g++",
    ),
    "no compiler at all": (
        "compiler",
        {"run": fake_run({"g++": CommandResult(127, ""), "gcc": CommandResult(127, "")})},
        Status.MISSING,
        "gcc and g++ not found",
        "sudo apt-get install g++",
    ),
    "no Python headers": (
        "compiler",
        {"headers": Path("/nowhere")},
        Status.MISSING,
        "not in /nowhere",
        "sudo apt-get install python3.12-dev",
    ),
    "no colcon": ("build tools", {"which": without("colcon")}, Status.MISSING, "colcon not found", "make setup"),
    "a later pytest": (
        "versions",
        {"package": {**VERSIONS, "pytest": "9.0.0"}.get},
        Status.WEAK,
        f"different from {DISTRIBUTION.platform}, the platform of {DISTRIBUTION.title}: "
        f"pytest 9.0.0 for {VERSIONS['pytest']}",
        "make setup",
    ),
    "no flake8": (
        "versions",
        {"package": {**VERSIONS, "flake8": None}.get},
        Status.WEAK,
        "flake8 is not found for 7.0.0",
        "make setup",
    ),
    "no CMake": ("build tools", {"which": without("cmake")}, Status.MISSING, "cmake not found", "make setup"),
    "no nbgrader": (
        "notebooks",
        {"package": lambda name: None if name == "nbgrader" else "1.2"},
        Status.MISSING,
        "nbgrader not installed",
        "make setup",
    ),
    "no bubblewrap": (
        "isolation",
        {"which": without("bwrap")},
        Status.MISSING,
        "bubblewrap is not installed",
        "sudo apt-get install bubblewrap",
    ),
    "Ubuntu's AppArmor restriction": (
        "isolation",
        {"namespaces_failure": lambda: DENIED, "read": sysctl("kernel.apparmor_restrict_unprivileged_userns", "1")},
        Status.WEAK,
        f"cannot create nested namespaces ({DENIED}): AppArmor restricts user namespaces",
        "sudo sysctl -w kernel.apparmor_restrict_unprivileged_userns=0",
    ),
    "a kernel that forbids user namespaces": (
        "isolation",
        {"namespaces_failure": lambda: DENIED, "read": sysctl("kernel.unprivileged_userns_clone", "0")},
        Status.WEAK,
        "the kernel forbids unprivileged user namespaces",
        "sudo sysctl -w kernel.unprivileged_userns_clone=1",
    ),
    "a kernel with no namespaces left": (
        "isolation",
        {"namespaces_failure": lambda: DENIED, "read": sysctl("user.max_user_namespaces", "0")},
        Status.WEAK,
        "does not allow any user namespaces",
        "sudo sysctl -w user.max_user_namespaces=15000",
    ),
    "a container that hides /proc": (
        "isolation",
        {
            "namespaces_failure": lambda: "bwrap: a warning\nbwrap: Can't mount proc",
            "read": {**FILES, Path("/.dockerenv"): ""}.get,
        },
        Status.WEAK,
        "cannot create nested namespaces (bwrap: Can't mount proc): this container's",
        "--security-opt systempaths=unconfined",
    ),
    "namespaces forbidden by something unknown": (
        "isolation",
        {"namespaces_failure": lambda: DENIED},
        Status.WEAK,
        "the kernel or a security module forbids it",
        "sudo dmesg | tail",
    ),
    "an unwritable folder for temporary files": (
        "disk",
        {"tmp": Path("/full"), "writable": unwritable("/full")},
        Status.MISSING,
        "/full is not writable",
        'export TMPDIR="$HOME/tmp"',
    ),
    "a full disk": (
        "disk",
        {"disk_usage": lambda path: SimpleNamespace(free=3 * 1024**2)},
        Status.WEAK,
        "0.0 GB free in /tmp",
        "df -h /tmp",
    ),
    "no browser": (
        "browser",
        {"which": without("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")},
        Status.WEAK,
        "no working Chromium",
        "sudo apt-get install chromium",
    ),
    "a student release that is older than the newest one": (
        "release",
        {
            "read": {
                **FILES,
                ROOT / "release.json": '{"version": "2026-05-04", "course": "/srv/newest"}',
                Path("/srv/newest/release.json"): '{"version": "2026-05-05"}',
            }.get
        },
        Status.WEAK,
        "version 2026-05-04; a newer one is available, 2026-05-05",
        "autograder update",
    ),
    "a browser that does not start": (
        "browser",
        {"run": fake_run({"--version": CommandResult(1, "snap needed")})},
        Status.WEAK,
        "no working Chromium",
        "sudo apt-get install chromium",
    ),
}


@pytest.mark.promise(
    "autograder doctor` says which command fixes it",
    "autograder doctor` names the command for each thing that is missing",
    "autograder doctor` detects many of these problems and names the command that fixes them",
    "autograder doctor` examines your machine and names the command that fixes each problem",
    "`autograder doctor` tells them when their release is out of date",
    "`autograder doctor` reports different versions on a machine",
    "| `g++: command not found` |",
)
@pytest.mark.parametrize(("name", "missing", "status", "text", "fix"), LACKS.values(), ids=LACKS.keys())
def test_a_missing_thing_is_named_with_the_command_that_fixes_it(
    name: str, missing: dict[str, Any], status: Status, text: str, fix: str
) -> None:
    reported = finding(name, **missing)
    assert reported.status is status
    assert text in reported.state
    assert fix in reported.fix
    assert not reported.state.endswith(".")


def test_a_weak_finding_leaves_a_machine_healthy_and_a_missing_thing_does_not() -> None:
    assert healthy(examine(complete_machine(in_venv=False)))
    assert not healthy(examine(complete_machine(which=without("bwrap"))))


def test_a_newest_release_and_a_release_without_a_newest_folder_are_fine() -> None:
    for course in ('"course": ""', '"course": "/srv/none"'):
        read = {**FILES, ROOT / "release.json": f'{{"version": "2026-05-04", {course}}}'}.get
        assert finding("release", read=read) == Finding("release", Status.OK, "version 2026-05-04")


def test_a_sourced_ros_is_fine_and_has_no_wheels_to_fix() -> None:
    without_environment = complete_machine(find_ros=lambda: SOURCED, prefix=Path("/course/bare"))
    findings = examine(without_environment)
    assert {reported.status for reported in findings} == {Status.OK}
    assert "CMake files" not in [reported.name for reported in findings]


def test_rclpy_is_started_with_the_log_folder_that_the_user_chose() -> None:
    environments: list[Mapping[str, str]] = []

    def run(command: Sequence[str], variables: Mapping[str, str]) -> CommandResult:
        environments.append(variables)
        return CommandResult(0, "fine")

    examine(complete_machine(run=run, environ={"ROS_LOG_DIR": "/mine"}))
    started = next(variables for variables in environments if variables)
    assert (started["ROS_LOG_DIR"], started["AMENT_PREFIX_PATH"]) == ("/mine", str(VENV))


def test_the_report_aligns_findings_and_never_breaks_a_command() -> None:
    command = "sudo " + "x" * 200
    findings = [
        Finding("Python", Status.OK, "Python 3.12.1"),
        Finding("isolation", Status.MISSING, "a long story " * 12, command),
        Finding("browser", Status.WEAK, "none", "sudo apt-get install chromium"),
    ]
    lines = render(findings, width=60).splitlines()
    assert lines[0] == "ok       Python     Python 3.12.1"
    assert lines[1].startswith("missing  isolation  a long story")
    assert " " * 20 + f"fix: {command}" in lines
    assert max(len(line) for line in lines if "fix:" not in line) <= 60
    assert lines[-1] == "Something is missing. 1 ok, 1 weak, 1 missing."
    assert render(findings[:1]).endswith("Nothing is missing. 1 ok, 0 weak, 0 missing.")


@pytest.mark.promise(".venv/bin/autograder doctor")
def test_this_machine_can_run_the_course() -> None:
    findings = {reported.name: reported for reported in examine(System())}
    for name in ("Python", "environment", "ROS 2", "rclpy", "compiler", "build tools", "notebooks", "disk"):
        assert findings[name].status is Status.OK, findings[name]


def test_the_real_probes_report_missing_things_instead_of_raising(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    system = System()
    assert system.run(["no-such-command-anywhere"], {}).status == 127
    result = system.run(
        [sys.executable, "-c", "import os; print(os.environ['X']); raise SystemExit('why')"], {"X": "y"}
    )
    assert (result.status, result.output, result.last_line) == (1, "y\nwhy\n", "why")
    assert system.read(tmp_path / "nothing") is None
    assert system.package("no-such-distribution-anywhere") is None
    assert system.which("no-such-command-anywhere") is None
    assert system.writable(tmp_path / "made" / "later")
    assert not system.writable(Path("/proc/nothing"))
    monkeypatch.setenv("TMPDIR", "/proc")
    assert System().tmp == Path("/proc")


def test_a_command_that_does_not_end_is_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("autograder.doctor.system.COMMAND_TIMEOUT_SECONDS", 0.2)
    result = System().run([sys.executable, "-c", "import threading; threading.Event().wait()"], {})
    assert (result.status, result.last_line) == (124, f"{sys.executable} did not end within 0.2 s")


@pytest.fixture
def uncached_probe() -> Iterator[None]:
    """Discard the cached probe of namespaces before and after the test."""
    namespaces_failure.cache_clear()
    yield
    namespaces_failure.cache_clear()


@pytest.mark.promise(
    "The command that `autograder doctor` prints", "`autograder doctor` in a container says whether that is sufficient"
)
def test_a_bubblewrap_without_namespaces_is_detected_on_this_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, uncached_probe: None
) -> None:
    denied = tmp_path / "bwrap"
    denied.write_text(f"#!/bin/sh\necho '{DENIED}' >&2\nexit 1\n")
    denied.chmod(denied.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    isolation = next(reported for reported in examine(System()) if reported.name == "isolation")
    assert (isolation.status, DENIED in isolation.state, bool(isolation.fix)) == (Status.WEAK, True, True)


def test_a_broken_python_environment_is_detected_on_this_machine(tmp_path: Path) -> None:
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").write_text("raise ImportError('half an installation')\n")
    code = "from autograder.doctor import *; f = examine(System()); print(render(f)); raise SystemExit(not healthy(f))"
    environ = {
        **os.environ,
        "PYTHONPATH": str(tmp_path),
        "ROS_DISTRO": DISTRIBUTION.name,
        "AMENT_PREFIX_PATH": f"{tmp_path}:{sys.prefix}",
    }
    completed = subprocess.run([sys.executable, "-c", code], env=environ, capture_output=True, text=True, timeout=120)
    assert completed.returncode == 1, completed.stderr
    output = " ".join(completed.stdout.split())
    assert "a node does not start: ImportError: half an installation" in output
    assert "the wheels are also installed" in output


@pytest.mark.parametrize(
    ("bounds", "message", "fix"),
    [
        (set(), "a fork bomb would succeed", "adduser grader && su grader"),
        ({"pids"}, "but not socket buffers and inodes", "systemd-run --user --scope autograder doctor"),
    ],
)
def test_a_limit_without_a_control_group_is_reported(bounds: set[str], message: str, fix: str) -> None:
    reported = finding("isolation", bounds=lambda: frozenset(bounds))
    assert (reported.status, reported.fix) == (Status.WEAK, fix)
    assert message in reported.state
