"""Findings about ROS 2: whether it is installed and complete, and which variables silently break it."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from autograder.doctor.finding import Finding, Status
from autograder.doctor.system import System
from autograder.ros import RosEnvironment, RosNotFoundError, WrongDistroError
from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.launch_packages import STANDINS

CLEAN_SHELL = 'env -i HOME="$HOME" PATH="$PATH" TERM="$TERM" bash --norc'

_PROBE = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("doctor")
node.create_publisher(String, "doctor", 1)
rclpy.shutdown()
"""

# Environment variables that silently change the behaviour of rclpy or Fast DDS, and their effect.
_STRAY = {
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "prevents discovery inside the sandbox",
    "ROS_LOCALHOST_ONLY": "prevents discovery inside the sandbox",
    "ROS_STATIC_PEERS": "sends discovery to other machines",
    "ROS_DISCOVERY_SERVER": "sends discovery to a server",
    "FASTRTPS_DEFAULT_PROFILES_FILE": "changes the DDS transport",
    "FASTDDS_DEFAULT_PROFILES_FILE": "changes the DDS transport",
    "ROS_SECURITY_ENABLE": "requires keys from every node",
}
_HARMLESS = {"ROS_AUTOMATIC_DISCOVERY_RANGE": ("SUBNET",), "ROS_LOCALHOST_ONLY": ("0",)}


def examine(system: System) -> list[Finding]:
    """Return the findings about ROS 2. If it is missing, only logs and variables are examined."""
    try:
        ros = system.find_ros()
    except WrongDistroError as error:
        return [Finding("ROS 2", Status.MISSING, str(error), CLEAN_SHELL), log_folder(system, None), variables(system)]
    except RosNotFoundError as error:
        return [Finding("ROS 2", Status.MISSING, str(error), "make setup"), log_folder(system, None), variables(system)]
    return [
        installation(system, ros),
        *([cmake_files(system, ros)] if ros.kind == "wheels" else []),
        launch(system),
        log_folder(system, ros),
        start(system, ros),
        variables(system),
    ]


def installation(system: System, ros: RosEnvironment) -> Finding:
    """Check that this is the course's ROS 2, either from wheels or sourced, but not both."""
    manifests = [system.read(_manifest(prefix)) for prefix in ros.prefixes]
    version = re.search(r"<version>\s*([^<\s]+)", next((text for text in manifests if text), ""))
    if version is None:
        return Finding("ROS 2", Status.MISSING, f"{ros.describe()}, but its rclpy has no package.xml", "make setup")
    version_text = f"{ros.describe()}, rclpy {version[1]}"
    if not version[1].startswith(f"{DISTRIBUTION.rclpy}."):
        state = f"rclpy {version[1]} in {ros.prefixes[0]} is not {DISTRIBUTION.title}'s, which is {DISTRIBUTION.rclpy}"
        return Finding("ROS 2", Status.MISSING, state, "make setup")
    if ros.kind == "sourced" and system.read(_manifest(system.prefix)) is not None:
        state = f"{version_text}; the wheels are also installed, and the two mix their libraries"
        return Finding("ROS 2", Status.WEAK, state, "make setup")
    return Finding("ROS 2", Status.OK, version_text)


def launch(system: System) -> Finding:
    """Check whether `launch` and `ros2` are the real ones or the course's stand-ins."""
    description = system.describe_launch()
    if description == STANDINS:
        description = "the course's stand-ins; `make real-launch` installs the real ones if GitHub is reachable"
    return Finding("launch, ros2", Status.OK, description)


def _manifest(prefix: Path) -> Path:
    return prefix / "share" / "rclpy" / "package.xml"


def cmake_files(system: System, ros: RosEnvironment) -> Finding:
    """Check that the wheels' CMake files were patched. Message packages do not compile otherwise."""
    count = len(system.unpatched_cmake_files(ros.prefixes[0]))
    if count:
        state = f"{count} CMake files of the wheels point at another machine's folders: message packages do not compile"
        return Finding("CMake files", Status.MISSING, state, f"{sys.executable} -m autograder.ros.patch_wheels")
    return Finding("CMake files", Status.OK, "the wheels' CMake files point at this environment")


def log_folder(system: System, ros: RosEnvironment | None) -> Finding:
    """Check that the log folder is writable. Otherwise `rclpy.init` raises an exception."""
    configured_folder = system.environ.get("ROS_LOG_DIR")
    folder = Path(configured_folder or (ros.variables()["ROS_LOG_DIR"] if ros else system.tmp))
    if system.writable(folder):
        return Finding("ROS logs", Status.OK, f"written to {folder}")
    state = f"the folder for ROS logs, {folder}, is not writable"
    return Finding(
        "ROS logs", Status.MISSING, state, "unset ROS_LOG_DIR" if configured_folder else "export ROS_LOG_DIR=~/.ros/log"
    )


def start(system: System, ros: RosEnvironment) -> Finding:
    """Start a node with a publisher in a child process, as every chapter does."""
    environment = ros.variables()
    if "ROS_LOG_DIR" in system.environ:
        environment["ROS_LOG_DIR"] = system.environ["ROS_LOG_DIR"]
    result = system.run([sys.executable, "-c", _PROBE], environment)
    if result.status == 0:
        return Finding("rclpy", Status.OK, "a node starts, publishes and stops")
    fix = "make setup" if ros.kind == "wheels" else f"source {DISTRIBUTION.setup}"
    return Finding("rclpy", Status.MISSING, f"a node does not start: {result.last_line}", fix)


def variables(system: System) -> Finding:
    """Check for environment variables, perhaps from another project's shell, that affect discovery."""
    environ = system.environ
    stray_variables = {
        name: effect
        for name, effect in _STRAY.items()
        if environ.get(name) and environ[name] not in _HARMLESS.get(name, ())
    }
    middleware = environ.get("RMW_IMPLEMENTATION", "")
    if middleware not in ("", "rmw_fastrtps_cpp"):
        stray_variables["RMW_IMPLEMENTATION"] = f"selects {middleware}, but the course needs rmw_fastrtps_cpp"
    domain = environ.get("ROS_DOMAIN_ID", "")
    if domain and not (domain.isdecimal() and int(domain) <= 232):
        stray_variables["ROS_DOMAIN_ID"] = f"is {domain}, but must be 0 to 232"
    if not stray_variables:
        return Finding("ROS variables", Status.OK, "none that affects discovery")
    blocking_variables = {"RMW_IMPLEMENTATION", "ROS_DOMAIN_ID"} & set(stray_variables)
    state = "; ".join(f"{name} {effect}" for name, effect in stray_variables.items())
    return Finding(
        "ROS variables",
        Status.MISSING if blocking_variables else Status.WEAK,
        state,
        f"unset {' '.join(stray_variables)}",
    )
