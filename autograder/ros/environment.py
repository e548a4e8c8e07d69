"""Finds ROS 2, and activates it for this process and its children."""

from __future__ import annotations

import importlib.util
import os
import sys
import sysconfig
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from autograder.ros.distribution import DISTRIBUTION
from autograder.ros.exceptions import RosNotFoundError, WrongDistroError
from autograder.ros.log_folder import log_folder

# The wheels' start-up hook sets these two variables for one Python prefix. They must not leak into another prefix.
WHEEL_BOOTSTRAP_VARIABLES = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")

# ROS logs to stderr by default. Jupyter shows stderr in red and late, but stdout in order. Only notebooks set this
# variable, so that programs in a terminal print what they print with any ROS.
LOGS_TO_STDOUT = {"RCUTILS_LOGGING_USE_STDOUT": "1"}


def without_wheel_bootstrap(environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variables for a Python that has to run the wheels' start-up hook again.

    LD_LIBRARY_PATH is removed only if the hook set it. The value of a sourced ROS is kept.
    """
    marker = WHEEL_BOOTSTRAP_VARIABLES[0]
    dropped_names = WHEEL_BOOTSTRAP_VARIABLES if environ.get(marker) else ()
    return {name: value for name, value in environ.items() if name not in dropped_names}


def site_packages(prefix: Path) -> Path:
    """Return the folder of an install prefix that contains its Python modules."""
    return prefix / f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages"


@dataclass(frozen=True)
class RosEnvironment:
    """A ROS 2 installation that this interpreter can import.

    Attributes:
        kind: `wheels` (pip, in this virtual environment) or `sourced` (a `setup.bash` was sourced).
        prefixes: the ament prefixes of the installation, in order of precedence, without those of sourced workspaces.
        rclpy: the folder from which `import rclpy` loads the package.
    """

    kind: Literal["wheels", "sourced"]
    prefixes: tuple[Path, ...]
    rclpy: Path

    def describe(self) -> str:
        """Return one line that names the distribution, the kind of installation and its folder."""
        origin = "wheels in" if self.kind == "wheels" else "sourced from"
        return f"ROS 2 {DISTRIBUTION.title}, {origin} {self.prefixes[0]}"

    def variables(
        self,
        *,
        overlays: tuple[Path, ...] = (),
        domain: int | None = None,
        log_dir: Path | None = None,
    ) -> dict[str, str]:
        """Return the environment variables that a process needs to use this ROS 2.

        Args:
            overlays: install prefixes of colcon workspaces, in order of precedence. They take precedence over the
                installation.
            domain: `ROS_DOMAIN_ID` (0 to 232). By default, it is not set.
            log_dir: a writable folder for log files, without which `rclpy.init` raises an error. The default is
                `log_folder()`.

        Raises:
            ValueError: `domain` is outside 0..232.
        """
        if domain is not None and not 0 <= domain <= 232:
            raise ValueError(f"ROS_DOMAIN_ID must be 0 to 232, not {domain}")
        path = os.pathsep.join(str(prefix) for prefix in (*overlays, *self.prefixes))
        variables = {
            "AMENT_PREFIX_PATH": path,
            "CMAKE_PREFIX_PATH": path,
            **DISTRIBUTION.variables,
            # Over shared memory, processes with different /dev/shm discover each other but receive no messages.
            "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
            "RCUTILS_LOGGING_BUFFERED_STREAM": "0",
            "ROS_LOG_DIR": str(log_dir or log_folder()),
        }
        if domain is not None:
            variables["ROS_DOMAIN_ID"] = str(domain)
        return variables


def find(environ: Mapping[str, str] | None = None) -> RosEnvironment:
    """Find the ROS 2 that this interpreter would import.

    Args:
        environ: the environment variables to use, `os.environ` by default.

    Raises:
        RosNotFoundError: `rclpy` cannot be imported.
        WrongDistroError: a ROS 2 of another distribution is sourced.
    """
    environ = os.environ if environ is None else environ
    spec = importlib.util.find_spec("rclpy")
    if spec is None or spec.origin is None:
        raise RosNotFoundError(
            f"rclpy cannot be imported: run `make setup`, or source a ROS 2 {DISTRIBUTION.title} installation"
        )
    rclpy = Path(spec.origin).parent
    venv = Path(sys.prefix)
    if rclpy.is_relative_to(venv):
        return RosEnvironment("wheels", (venv,), rclpy)
    distro = environ.get("ROS_DISTRO", "")
    if distro != DISTRIBUTION.name:
        raise WrongDistroError(
            f"the sourced ROS 2 is {distro or 'of no known distribution'}, the course needs {DISTRIBUTION.title}: "
            f"open a shell without it, or source {DISTRIBUTION.setup}"
        )
    prefixes = tuple(Path(part) for part in environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part)
    # The prefixes before the installation are workspaces: sourced by the user, or built and loaded by this process.
    installation_indices = [index for index, prefix in enumerate(prefixes) if rclpy.is_relative_to(prefix)]
    if not installation_indices:
        raise RosNotFoundError(f"rclpy is at {rclpy}, but not in AMENT_PREFIX_PATH: source {DISTRIBUTION.setup}")
    return RosEnvironment("sourced", prefixes[installation_indices[0] :], rclpy)


def activate(*, overlays: tuple[Path, ...] = (), domain: int | None = None) -> RosEnvironment:
    """Activate ROS 2 for this process and its children. A second call changes nothing.

    Call it before the first `import rclpy`. Workspaces that are already sourced stay sourced. PATH is extended so that
    it contains `ros2` and `colcon` even if the virtual environment was not activated, as in a notebook's kernel.

    Raises:
        RosError: no usable ROS 2 of the course's distribution was found.
    """
    environment = find()
    sourced_prefixes = [Path(part) for part in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    workspaces = tuple(path for path in sourced_prefixes if path not in {*overlays, *environment.prefixes})
    variables = environment.variables(overlays=(*overlays, *workspaces), domain=domain)
    # If the user has set one of these, keep that value.
    for name in ("ROS_LOG_DIR", "FASTDDS_BUILTIN_TRANSPORTS"):
        if name in os.environ:
            variables.pop(name)
    os.environ.update(variables)
    os.environ["PATH"] = path_with_scripts()
    return environment


def path_with_scripts() -> str:
    """Return PATH, with this Python's scripts folder in front if PATH does not contain it."""
    scripts, path = sysconfig.get_path("scripts"), os.environ.get("PATH", os.defpath)
    return path if scripts in path.split(os.pathsep) else os.pathsep.join([scripts, path])
