"""Findings about the machine: Python, compilers, tools, the sandbox's namespaces, disk space."""

from __future__ import annotations

import json
from pathlib import Path

from autograder import course_paths
from autograder.author.student_release import MANIFEST
from autograder.doctor.apt import TOOLS
from autograder.doctor.finding import Finding, Status
from autograder.doctor.system import System
from autograder.ros.distribution import DISTRIBUTION

RECOMMENDED_FREE_BYTES = 2 * 1024**3

_SYSCTL = Path("/proc/sys")
# Kernel settings that forbid user namespaces: the file, the value that forbids them, the reason, the fix.
_FORBIDDING_SETTINGS = (
    (
        "kernel.apparmor_restrict_unprivileged_userns",
        "1",
        "AppArmor restricts user namespaces, which Ubuntu does by default since 24.04",
        "sudo sysctl -w kernel.apparmor_restrict_unprivileged_userns=0",
    ),
    (
        "kernel.unprivileged_userns_clone",
        "0",
        "the kernel forbids unprivileged user namespaces",
        "sudo sysctl -w kernel.unprivileged_userns_clone=1",
    ),
    (
        "user.max_user_namespaces",
        "0",
        "the kernel does not allow any user namespaces",
        "sudo sysctl -w user.max_user_namespaces=15000",
    ),
)
_CONTAINER_MARKS = (Path("/.dockerenv"), Path("/run/.containerenv"))
_CONTAINER_OPTIONS = (
    "docker run --security-opt seccomp=unconfined --security-opt apparmor=unconfined "
    "--security-opt systempaths=unconfined"
)


def python(system: System) -> Finding:
    """Check that the ROS wheels support the interpreter and the platform."""
    version = ".".join(map(str, system.python))
    name, machine = system.platform
    if system.platform != ("Linux", "x86_64"):
        state = f"{name} {machine}: the course runs on Linux x86-64; use a container or a JupyterHub"
        return Finding("Python", Status.MISSING, state, "devcontainer up --workspace-folder .")
    if "{}.{}".format(*system.python) not in DISTRIBUTION.pythons:
        state = f"Python {version}: ROS 2 {DISTRIBUTION.title} supports Python {DISTRIBUTION.supported}"
        return Finding("Python", Status.MISSING, state, f"make setup PYTHON=python{DISTRIBUTION.pythons[0]}")
    return Finding("Python", Status.OK, f"Python {version} on {name} {machine}")


def environment(system: System) -> Finding:
    """Check that this is a virtual environment, because the system's Python does not have the pinned versions."""
    if system.in_venv:
        return Finding("environment", Status.OK, f"the virtual environment {system.prefix}")
    state = f"not a virtual environment ({system.prefix}): packages may not have their pinned versions"
    return Finding("environment", Status.WEAK, state, "make setup")


def other_users(system: System) -> tuple[Finding, ...]:
    """Check that other users of this machine, such as a class, can run what root has set up."""
    reason = system.closed_to_other_users()
    return (Finding("other users", Status.WEAK, reason, "make setup PYTHON=/usr/bin/python3"),) if reason else ()


def compiler(system: System) -> Finding:
    """Check for the compilers and Python headers that are needed to build message definitions."""
    missing = [command for command in ("gcc", "g++") if system.run([command, "--version"], {}).status != 0]
    if missing:
        state = f"{' and '.join(missing)} not found: message packages cannot be compiled"
        return Finding("compiler", Status.MISSING, state, "sudo apt-get install g++")
    if system.read(system.headers / "Python.h") is None:
        state = f"Python's headers are not in {system.headers}: message packages cannot be compiled"
        package = "python{}.{}-dev".format(*system.python)
        return Finding("compiler", Status.MISSING, state, f"sudo apt-get install {package}")
    return Finding("compiler", Status.OK, system.run(["g++", "--version"], {}).output.splitlines()[0])


def build_tools(system: System) -> Finding:
    """Check for colcon and CMake."""
    missing = [command for command in ("colcon", "cmake") if system.which(command) is None]
    if missing:
        return Finding("build tools", Status.MISSING, f"{' and '.join(missing)} not found", "make setup")
    return Finding("build tools", Status.OK, f"colcon in {system.which('colcon')}, cmake in {system.which('cmake')}")


def versions(system: System) -> Finding:
    """Check that the packages that students use have the same versions as on ROS's platform."""
    platform, packages = DISTRIBUTION.platform, DISTRIBUTION.packages
    differences = DISTRIBUTION.differences({p.name: system.package(p.name) for p in packages})
    if not differences:
        version_list = ", ".join(f"{p.name} {p.version}" for p in packages)
        return Finding("versions", Status.OK, f"as on {platform}: {version_list}")
    state = "; ".join(f"{p.name} {version or 'is not found'} for {p.version}" for p, version in differences.items())
    if all(package.differs and version for package, version in differences.items()):
        return Finding("versions", Status.OK, f"as on {platform}, except {state}: the nearest for this Python")
    return Finding(
        "versions",
        Status.WEAK,
        f"different from {platform}, the platform of {DISTRIBUTION.title}: {state}",
        "make setup",
    )


def notebooks(system: System) -> Finding:
    """Check for JupyterLab and nbgrader."""
    versions = {name: system.package(name) for name in ("jupyterlab", "nbgrader", "ipykernel")}
    missing = [name for name, version in versions.items() if version is None]
    if missing:
        return Finding("notebooks", Status.MISSING, f"{', '.join(missing)} not installed", "make setup")
    return Finding("notebooks", Status.OK, ", ".join(f"{name} {version}" for name, version in versions.items()))


def isolation(system: System) -> Finding:
    """Try the two nested namespaces of grading: one around a submission, one around the student's code."""
    if system.which("bwrap") is None:
        state = "bubblewrap is not installed: submissions cannot be graded in isolation"
        return Finding("isolation", Status.MISSING, state, "sudo apt-get install bubblewrap")
    failure, bounds = system.namespaces_failure(), system.bounds()
    if failure is not None:
        reason, fix = _reason_and_fix(system)
        state = f"bubblewrap cannot create nested namespaces ({failure.splitlines()[-1]}): {reason}"
        return Finding("isolation", Status.WEAK, f"{state}; only the weaker isolation level is available", fix)
    if "pids" not in bounds:
        state = "only control groups can limit root's processes, but none can be created: a fork bomb would succeed"
        return Finding("isolation", Status.WEAK, state, "adduser grader && su grader")
    if "memory" not in bounds:
        state = (
            "bubblewrap creates nested namespaces; no control group can be created, so only the memory of processes "
            "is limited, but not socket buffers and inodes"
        )
        return Finding("isolation", Status.WEAK, state, "systemd-run --user --scope autograder doctor")
    state = "bubblewrap creates nested namespaces; control groups limit memory and processes"
    return Finding("isolation", Status.OK, state)


def _reason_and_fix(system: System) -> tuple[str, str]:
    """Return why user namespaces cannot be created, and the command that fixes it."""
    for setting, value, reason, fix in _FORBIDDING_SETTINGS:
        if (system.read(_SYSCTL / setting.replace(".", "/")) or "").strip() == value:
            return reason, fix
    if any(system.read(mark) is not None for mark in _CONTAINER_MARKS):
        return "this container's security profile forbids it", _CONTAINER_OPTIONS
    return "the kernel or a security module forbids it", "sudo dmesg | tail"


def release(system: System) -> tuple[Finding, ...]:
    """Check whether a newer student release is available. The course itself is not a release."""
    installed_release = json.loads(system.read(course_paths.ROOT / MANIFEST) or "{}")
    newest_release = json.loads(
        (system.read(Path(installed_release["course"], MANIFEST)) if installed_release.get("course") else None) or "{}"
    )
    if not installed_release:
        return ()
    if newest_release and newest_release["version"] > installed_release["version"]:
        state = f"version {installed_release['version']}; a newer one is available, {newest_release['version']}"
        return (Finding("release", Status.WEAK, state, "autograder update"),)
    return (Finding("release", Status.OK, f"version {installed_release['version']}"),)


def space(system: System) -> Finding:
    """Check that there is enough disk space for workspaces and builds."""
    if not system.writable(system.tmp):
        state = f"{system.tmp} is not writable, but workspaces and builds go there"
        return Finding("disk", Status.MISSING, state, 'export TMPDIR="$HOME/tmp" && mkdir -p "$TMPDIR"')
    free = system.disk_usage(system.tmp).free
    free_text = f"{free / 1024**3:.1f} GB free in {system.tmp}"
    if free < RECOMMENDED_FREE_BYTES:
        state = f"{free_text}: building and grading may need {RECOMMENDED_FREE_BYTES / 1024**3:.0f} GB"
        return Finding("disk", Status.WEAK, state, f"df -h {system.tmp}")
    return Finding("disk", Status.OK, free_text)


def browser(system: System) -> Finding:
    """Check for a browser, which only the browser tests need."""
    for command in TOOLS["chromium"]:
        if system.which(command) is not None:
            result = system.run([command, "--version"], {})
            if result.status == 0:
                return Finding("browser", Status.OK, result.last_line)
    state = "no working Chromium; only the browser tests need it"
    return Finding("browser", Status.WEAK, state, "sudo apt-get install chromium")
